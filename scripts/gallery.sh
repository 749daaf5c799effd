#!/usr/bin/env bash
# Makes the pictures of docs/effects.md in docs/images/gallery/, 256x256. An argument is the number of camera paths per pixel.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

spp=${1:-256}
cohort=${CARGO_TARGET_DIR:-target}/release/cohort
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p docs/images/gallery

cargo build --release
for scene in scenes/gallery/*.xml; do
    name=$(basename "$scene" .xml)
    case $name in camera | stage | lamp) continue ;; esac # what the others include
    "$cohort" render "$scene" --strategy roulette --spp "$spp" -o "$work/$name.exr"
    mv "$work/$name.png" docs/images/gallery/
done
