#!/usr/bin/env bash
# The paper's experiment (Kitaoka, Kitamura and Kishino): both scenes at 800x800, spectral, one thread, by Russian roulette,
# go-with-the-winners and the particle filter, in the paper's literal form and in Cohort's.
#
#   scripts/paper.sh [--minutes M] [--repeat R] [-o DIR]
#
# Each strategy gets M minutes per scene (default 30, as in the paper), as R independent repetitions (default 5) of M/R minutes, so that
# intervals are known; the pictures are the means of the repetitions. A reference gets M minutes on all cores. In all, M = 30 takes five
# hours. DIR (default renders/paper) gets a report for each scene, armadillo/index.html and lucy/index.html; in each, figure.png is
# laid out as the paper's figures 6 and 7. If it is interrupted, the same command goes on. COHORT_MODELS names the folder of the models.
set -euo pipefail

minutes=30
repeat=5
output=renders/paper
while [ $# -gt 0 ]; do
    case $1 in
        --minutes) minutes=$2; shift 2 ;;
        --repeat) repeat=$2; shift 2 ;;
        -o) output=$2; shift 2 ;;
        *) echo "usage: scripts/paper.sh [--minutes M] [--repeat R] [-o DIR]" >&2; exit 2 ;;
    esac
done
cd "$(dirname "${BASH_SOURCE[0]}")/.."

cargo build --release
cohort=${CARGO_TARGET_DIR:-target}/release/cohort
mkdir -p "$output"
for model in armadillo lucy; do
    "$cohort" compare "scenes/cornell-$model.xml" --size 800x800 --threads 1 \
        --strategies roulette,go-with-the-winners,paper-particle-filter,particle-filter:rule=importance \
        --time "$((minutes * 60 / repeat))s" --repeat "$repeat" --reference-time "${minutes}m" \
        -o "$output/$model"
done
