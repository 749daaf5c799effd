#!/usr/bin/env bash
# Cohort against Mitsuba 3 at equal time: both paper scenes, 400x400, one thread, RGB and spectral, against the scalar and the compiled variants.
#
#   scripts/peers.sh [--seconds S] [-o DIR] [--references DIR]
#
# Each competitor gets five times S seconds (default 60), the reference twelve times; --references takes the
# references of an earlier run from its folder. DIR (default renders/peers) gets a report for each scene and colour mode. If it is
# interrupted, the same command goes on. COHORT_MODELS names the folder of the models; Mitsuba is installed if it is not there.
set -euo pipefail

seconds=60
output=renders/peers
references=
while [ $# -gt 0 ]; do
    case $1 in
        --seconds) seconds=$2; shift 2 ;;
        -o) output=$2; shift 2 ;;
        --references) references=$2; shift 2 ;;
        *) echo "usage: scripts/peers.sh [--seconds S] [-o DIR] [--references DIR]" >&2; exit 2 ;;
    esac
done
cd "$(dirname "${BASH_SOURCE[0]}")/.."

export COHORT_MITSUBA_PYTHON="${COHORT_MITSUBA_PYTHON:-$(scripts/mitsuba-venv.sh)}"
cargo build --release
cohort=${CARGO_TARGET_DIR:-target}/release/cohort
mkdir -p "$output"
for model in armadillo lucy; do
    for colour in rgb spectral; do
        mode=()
        [ "$colour" = spectral ] || mode=(--rgb)
        reference=(--reference-time "$((12 * seconds))s")
        [ -z "$references" ] || reference=(--reference "$references/$model-$colour/images/reference.exr")
        "$cohort" compare "scenes/cornell-$model.xml" --size 400x400 --threads 1 "${mode[@]}" \
            --strategies throughput-roulette,roulette,particle-filter:rule=importance \
            --peer "mitsuba:scalar_$colour,mitsuba:llvm_ad_$colour" \
            --time "${seconds}s" "${reference[@]}" -o "$output/$model-$colour"
    done
done
