#!/usr/bin/env bash
# Installs what Cohort needs on Debian 12 or 13: Embree, build tools and Rust by rustup; with the argument `tests`, what they need as well.
# Does nothing where everything is there already. Run as root or by somebody who may use sudo.
set -euo pipefail

packages=(
    build-essential pkg-config libembree-dev libclang-dev   # to build
    ca-certificates curl git                                # to get Rust and the sources
)
case "${1:-}" in
    '') ;;
    tests)
        packages+=(
            python3 python3-venv libllvm19                  # Mitsuba, which the tests compare with
            chromium chromium-driver                        # to open the pages of reports
            debootstrap                                     # to test on Debian 13
        )
        ;;
    *) echo "usage: scripts/install-debian.sh [tests]" >&2; exit 2 ;;
esac

installed() { [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

missing=()
for package in "${packages[@]}"; do
    installed "$package" || missing+=("$package")
done

if [ ${#missing[@]} -gt 0 ]; then
    as_root=()
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null; then
            echo "Missing packages: ${missing[*]}. Install them as root, or install sudo." >&2
            exit 1
        fi
        as_root=(sudo)
    fi
    echo "Installing Debian packages: ${missing[*]}"
    # A source that does not answer is no reason to stop while the others have the packages.
    "${as_root[@]}" apt-get update || echo "Warning: apt-get update failed; trying with the lists at hand." >&2
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends "${missing[@]}"
fi

if ! command -v cargo >/dev/null && [ ! -x "${CARGO_HOME:-$HOME/.cargo}/bin/cargo" ]; then
    echo "Installing Rust by rustup"
    curl --proto '=https' --tlsv1.2 -sSf https://sh.rustup.rs | sh -s -- -y --profile default
fi
