#!/usr/bin/env bash
# Tests Cohort on Debian 13, whose Embree 4 differs from Debian 12's Embree 3, from whatever Debian
# this runs on: in a Debian 13 root that debootstrap makes once and that is kept outside the checkout.
#
#   scripts/test-debian13.sh
#
# It must run as root, with debootstrap installed and Rust at hand; where it cannot run it says
# SKIPPED and succeeds. Variables: COHORT_CACHE, where the root and its build are kept (default
# ~/.cache/cohort); DEBIAN_MIRROR, where the packages come from (default: apt's mirror here).
set -euo pipefail

checkout=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/debian-root.sh
. "$checkout/scripts/debian-root.sh"
packages=(libembree-dev libclang-dev g++ libc6-dev pkg-config ca-certificates)

cannot_run() {
    echo "============================================================" >&2
    echo "SKIPPED: the tests on Debian 13 (Embree 4) did not run: $1" >&2
    echo "============================================================" >&2
    exit 0
}

need_root_and cargo
enter_namespace "$@"
lock debian13
make_root debian13 trixie "${packages[@]}"
configure_network
mount_system

# The checkout is read-only, so that this cannot disturb a build here; Rust and its downloads are the host's.
target=$cache/debian13-target
mkdir -p "$target"
bind "$checkout" /checkout ro
bind "$target" /target
bind "${CARGO_HOME:-$HOME/.cargo}" /cargo
bind_rust "$checkout"
environment=(PATH=/rust/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 CARGO_HOME=/cargo CARGO_TARGET_DIR=/target)

# in_checkout COMMAND...: runs in the checkout, inside the root.
in_checkout() { inside sh -c 'cd /checkout && exec "$@"' sh "$@"; }

echo "Debian $(cat "$root/etc/debian_version"), Embree $(inside dpkg-query -W -f '${Version}' libembree-dev), $(in_checkout rustc --version)"

# Step 1: the tests of the Embree layer, against Embree 4.
in_checkout cargo test --locked --lib embree
in_checkout cargo test --locked --test embree_threads

# Step 2: one small render in both systems; the second to render compares its images with the first's.
rm -rf "$target/exchange"
mkdir -p "$target/exchange"
in_checkout env COHORT_EXCHANGE=/target/exchange cargo test --locked --test across_systems
(cd "$checkout" && COHORT_EXCHANGE="$target/exchange" cargo test --locked --test across_systems -- --nocapture)

echo "PASSED: the tests on Debian 13 (Embree 4)."
