#!/usr/bin/env bash
# Makes the pictures of the README in docs/images/: the built-in scene, and the paper's two scenes by three strategies, 60 s each at
# 800x800, halved. Takes seven minutes. COHORT_MODELS names the folder of the models.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

seconds=${1:-60}
python=$(scripts/mitsuba-venv.sh)
cohort=${CARGO_TARGET_DIR:-target}/release/cohort
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p docs/images

# halve NAME: docs/images/NAME.png at half the size of the render.
halve() {
    "$python" - "$work/$1.png" "docs/images/$1.png" <<'PYTHON'
import sys
import numpy as np
import mitsuba as mi
mi.set_variant("scalar_rgb")
full = np.array(mi.Bitmap(sys.argv[1])).astype(float)
height, width = full.shape[0] // 2, full.shape[1] // 2
half = full[: 2 * height, : 2 * width].reshape(height, 2, width, 2, -1).mean(axis=(1, 3))
mi.Bitmap((half + 0.5).astype(np.uint8)).write(sys.argv[2])
PYTHON
}

cargo build --release
"$cohort" render --strategy roulette --size 800x800 --time "${seconds}s" -o "$work/cornell-knot.exr"
halve cornell-knot
for model in armadillo lucy; do
    for strategy in roulette go-with-the-winners particle-filter; do
        name=$model-$strategy
        rule=()
        if [ "$strategy" = particle-filter ]; then
            rule=(--rule importance)
        fi
        "$cohort" render "scenes/cornell-$model.xml" --strategy "$strategy" "${rule[@]}" --time "${seconds}s" -o "$work/$name.exr"
        halve "$name"
    done
done
