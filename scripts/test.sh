#!/usr/bin/env bash
# Installs what the tests need and runs all of them, and checks the links of the documentation, on Debian 12 or 13.
# COHORT_MODELS may name a folder with armadillo.ply and lucy.ply, COHORT_SUITE one with Mitsuba's own scenes.
# COHORT_MITSUBA_PYTHON may name a Python that has Mitsuba; otherwise an environment with it is made.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/install-debian.sh tests
export PATH="${CARGO_HOME:-$HOME/.cargo}/bin:$PATH"
if [ -z "${COHORT_MITSUBA_PYTHON:-}" ]; then
    COHORT_MITSUBA_PYTHON="$(scripts/mitsuba-venv.sh)"
fi
export COHORT_MITSUBA_PYTHON

cargo test --workspace
cargo build --workspace --examples
RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps
