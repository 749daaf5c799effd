#!/usr/bin/env bash
# From a fresh Debian 12 or 13 to the first image: installs the packages, builds Cohort and renders the built-in scene.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/install-debian.sh
export PATH="${CARGO_HOME:-$HOME/.cargo}/bin:$PATH"
cargo build --release

image="$PWD/renders/cornell-knot"
mkdir -p renders
"${CARGO_TARGET_DIR:-target}/release/cohort" render --time 20s -o "$image.exr"

echo
echo "The image, linear and with its metadata: $image.exr"
echo "The same to look at:                     $image.png"
