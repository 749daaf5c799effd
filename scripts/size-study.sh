#!/usr/bin/env bash
# Cost against size: seconds per million paths, time to build and memory for meshes of 10^3 to 10^7 triangles and for images of 256^2 to
# 4096^2 pixels, with the fitted growth.
#
#   scripts/size-study.sh [--quick]
#
# Writes size.csv and size.md into cohort-bench/ of the target directory. The whole study needs about 3 GiB of memory; --quick goes up
# to 10^6 triangles and 1024^2 pixels.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

cargo bench --bench size -- "$@"
