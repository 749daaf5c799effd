#!/usr/bin/env bash
# Makes a Python environment with Mitsuba 3, which the tests compare with, and prints the path of its python.
# It is kept in COHORT_CACHE (by default cohort/ in the user's cache folder), outside the checkout.
set -euo pipefail

mitsuba=3.9.1
cache="${COHORT_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/cohort}"
venv="$cache/mitsuba-venv"

works() { "$venv/bin/python" -c "import mitsuba, numpy; assert mitsuba.__version__ == '$mitsuba'" 2>/dev/null; }

if ! works; then
    mkdir -p "$cache"
    if ! { python3 -m venv --clear "$venv" &&
        "$venv/bin/python" -m pip install --quiet --disable-pip-version-check "mitsuba==$mitsuba" numpy; } >&2 || ! works
    then
        echo "ERROR: Mitsuba $mitsuba could not be installed into $venv (see above)." >&2
        echo "The comparisons with Mitsuba need it: is the Python package index within reach?" >&2
        exit 1
    fi
fi
echo "$venv/bin/python"
