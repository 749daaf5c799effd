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
cache=${COHORT_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/cohort}
root=$cache/debian13
target=$cache/debian13-target
suite=trixie
packages=(libembree-dev libclang-dev g++ libc6-dev pkg-config ca-certificates)

skip() {
    echo "============================================================" >&2
    echo "SKIPPED: the tests on Debian 13 (Embree 4) did not run: $1" >&2
    echo "============================================================" >&2
    exit 0
}

[ "$(id -u)" = 0 ] || skip "they need root, to make and enter a Debian 13 root."
command -v debootstrap >/dev/null || skip "debootstrap is not installed (apt-get install debootstrap)."
command -v unshare >/dev/null || skip "unshare is not installed (apt-get install util-linux)."
command -v cargo >/dev/null || skip "cargo is not installed (https://rustup.rs)."

# Everything is mounted in a mount namespace of our own. The kernel takes the mounts away with its
# last process, however that ends; the trap below does so in order when the script ends by itself.
if [ "${COHORT_IN_NAMESPACE:-}" != 1 ]; then
    unshare --mount --propagation private true 2>/dev/null \
        || skip "this system does not let root mount (a container without that right?)."
    exec env COHORT_IN_NAMESPACE=1 unshare --mount --propagation private "$0" "$@"
fi

# One run at a time: two would make the same root.
mkdir -p "$cache"
exec 9>"$cache/debian13.lock"
flock 9

mounted=()
unmount_all() {
    local i
    for ((i = ${#mounted[@]} - 1; i >= 0; i--)); do
        umount "${mounted[i]}" || umount --lazy "${mounted[i]}" || true
    done
    mounted=()
}
trap unmount_all EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

# bind FROM TO [OPTION]: makes a directory of ours visible inside the root.
bind() {
    mkdir -p "$root$2"
    mount --bind "$1" "$root$2"
    mounted+=("$root$2")
    [ -z "${3:-}" ] || mount -o "remount,bind,$3" "$root$2"
}

# inside COMMAND...: runs in the root, with the proxies and nothing else of our environment.
inside() {
    local variable environment=(
        PATH=/cargo/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8
        DEBIAN_FRONTEND=noninteractive
    )
    for variable in http_proxy https_proxy ftp_proxy no_proxy HTTP_PROXY HTTPS_PROXY NO_PROXY \
        ALL_PROXY \
        CARGO_HTTP_PROXY CARGO_NET_OFFLINE CARGO_BUILD_JOBS; do
        [ -z "${!variable:-}" ] || environment+=("$variable=${!variable}")
    done
    if [ -f "$root/etc/ssl/host.crt" ]; then
        environment+=(SSL_CERT_FILE=/etc/ssl/host.crt CARGO_HTTP_CAINFO=/etc/ssl/host.crt)
    fi
    env -i "${environment[@]}" \
        CARGO_HOME=/cargo RUSTUP_HOME=/rustup CARGO_TARGET_DIR=/target \
        ${toolchain:+RUSTUP_TOOLCHAIN="$toolchain"} \
        chroot "$root" "$@"
}

# The mirror that apt uses here, without its suite.
host_mirror() {
    apt-get indextargets --format '$(SITE) $(RELEASE)' 'Created-By: Packages' 2>/dev/null \
        | awk '$1 ~ /\/debian\/?$/ { print $1; exit }'
}

# Brings in how the host reaches the net, which may differ from run to run: its resolver and the
# certificates that it trusts.
configure_network() {
    cp --dereference /etc/resolv.conf /etc/hosts "$root/etc/"
    local certificates=${SSL_CERT_FILE:-/etc/ssl/certs/ca-certificates.crt}
    mkdir -p "$root/etc/ssl"
    [ ! -f "$certificates" ] || cp --dereference "$certificates" "$root/etc/ssl/host.crt"
}

# Brings in how the host's apt fetches, and names the mirror for Debian 13.
configure_apt() {
    local setting
    for setting in apt.conf.d auth.conf.d; do
        mkdir -p "$root/etc/apt/$setting"
        # Only what tells apt how to fetch: hooks would call programs that are not there.
        find "/etc/apt/$setting" -type f ! -exec grep -qiE 'Invoke|Pre-Install|IndexTargets' {} \; \
            -exec cp {} "$root/etc/apt/$setting/" \;
    done
    [ ! -f /etc/apt/apt.conf ] || cp /etc/apt/apt.conf "$root/etc/apt/"
    echo "deb $mirror $suite main" >"$root/etc/apt/sources.list"
    rm -f "$root"/etc/apt/sources.list.d/*
}

# Makes the root. It is made under another name, so that one whose making was interrupted is never
# taken for whole; `finished` lists the packages, so that a change to them makes a new one.
make_root() {
    if [ "$(cat "$root/finished" 2>/dev/null)" = "$suite ${packages[*]}" ]; then
        return
    fi
    mirror=${DEBIAN_MIRROR:-$(host_mirror)}
    mirror=${mirror:-http://deb.debian.org/debian}
    echo "Making a Debian 13 root in $root from $mirror (once)." >&2
    local final=$root
    root=$final.new
    # Safe: nothing is mounted there. All mounts are made below, in this namespace, which is new.
    local old
    for old in "$final" "$root"; do
        if grep -qF " $old" /proc/self/mountinfo; then
            echo "Something is mounted in $old: unmount it first." >&2
            exit 1
        fi
        rm -rf --one-file-system "$old"
    done
    debootstrap --variant=minbase "$suite" "$root" "$mirror" >"$cache/debian13.log" 2>&1 \
        || { tail -n 20 "$cache/debian13.log" >&2; exit 1; }
    configure_network
    configure_apt
    {
        mount -t proc proc "$root/proc"
        mounted+=("$root/proc")
        inside apt-get update
        inside apt-get install --yes --no-install-recommends "${packages[@]}"
        inside apt-get clean
    } >>"$cache/debian13.log" 2>&1 || { tail -n 20 "$cache/debian13.log" >&2; exit 1; }
    unmount_all
    echo "$suite ${packages[*]}" >"$root/finished"
    mv "$root" "$final"
    root=$final
}

make_root
configure_network

# The checkout is read-only, so that this cannot disturb a build here; Rust is the host's.
mkdir -p "$target"
mount -t proc proc "$root/proc"
mounted+=("$root/proc")
bind /dev /dev
bind "$checkout" /checkout ro
bind "$target" /target
bind "${CARGO_HOME:-$HOME/.cargo}" /cargo
sysroot=$(cd "$checkout" && rustc --print sysroot)
rustup_home=${RUSTUP_HOME:-$HOME/.rustup}
if [ "${sysroot#"$rustup_home"/toolchains/}" != "$sysroot" ]; then
    bind "$rustup_home" /rustup ro
    toolchain=$(basename "$sysroot")
else
    # Rust without rustup: its directory, and its bin on the path instead of cargo's.
    bind "$sysroot" /cargo-toolchain ro
    toolchain=
fi

# in_checkout COMMAND...: runs in the checkout, inside the root.
in_checkout() {
    # shellcheck disable=SC2016
    inside sh -c 'PATH=/cargo-toolchain/bin:$PATH; cd /checkout && exec "$@"' sh "$@"
}

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
