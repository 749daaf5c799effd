#!/usr/bin/env bash
# Measures what each effect costs on each scene of the gallery, as rows of Markdown for docs/effects.md.
#
#     scripts/effect-costs.sh [SECONDS]
#
# SECONDS (default 3) are spent on each effect of each scene. The columns are those of `cohort explain --measure`.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
seconds=${1:-3}
cohort=${CARGO_TARGET_DIR:-target}/release/cohort
cargo build --release --quiet
echo "| scene | effect | cost |"
echo "|---|---|---|"
for scene in scenes/gallery/*.xml; do
    name=$(basename "$scene" .xml)
    case $name in camera | stage | lamp) continue ;; esac # what the others include
    # Columns have fixed widths: 22 characters for the effect, 5 for its state, 23 for the cost.
    "$cohort" explain "$scene" --measure="${seconds}s" \
        | awk -v name="$name" '
            { effect = substr($0, 1, 21); state = substr($0, 23, 2); cost = substr($0, 28, 22) }
            { sub(/ +$/, "", effect); sub(/ +$/, "", cost) }
            effect == "effect" { in_table = 1 }
            in_table && (state == "on" || effect == "all of them") { print "| `" name "` | " effect " | " cost " |" }'
done
