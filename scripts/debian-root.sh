# shellcheck shell=bash
# Makes Debian roots by debootstrap and runs commands in them by chroot. To be sourced by bash, not run.
#
# Whoever sources it defines `cannot_run REASON`, which ends the script, and then calls, in this order:
# need_root_and PROGRAM..., enter_namespace "$@", lock NAME, make_root NAME SUITE PACKAGE..., configure_network,
# mount_system, bind, and `inside` as often as it likes. All of these work on the root in $root.
#
# Variables of the person who runs it: COHORT_CACHE, where roots are kept (default ~/.cache/cohort, outside the
# checkout); DEBIAN_MIRROR, where packages come from (default: apt's mirror here).

cache=${COHORT_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/cohort}
root=
# NAME=value of every variable that commands in the root get, besides those in `network`.
environment=(PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root DEBIAN_FRONTEND=noninteractive)
# NAME=value of the variables that say how to reach the net from here.
network=()
# Who runs commands in the root: nothing for root, or USER:GROUP.
user=
mounted=()

# need_root_and PROGRAM...: goes on only where a root can be made and entered.
need_root_and() {
    local program
    [ "$(id -u)" = 0 ] || cannot_run "it takes root to make and enter a Debian root."
    for program in debootstrap unshare "$@"; do
        command -v "$program" >/dev/null || cannot_run "$program is not installed."
    done
    # Found now: the PATH that commands in the root get may have no sbin.
    chroot=$(command -v chroot)
}

# enter_namespace ARGUMENT...: starts the script again in a mount namespace of its own, where everything is mounted.
# The kernel takes the mounts away with its last process, however that ends; the trap below does so in order when the
# script ends by itself.
enter_namespace() {
    if [ "${COHORT_IN_NAMESPACE:-}" != 1 ]; then
        unshare --mount --propagation private true 2>/dev/null \
            || cannot_run "this system does not let root mount (a container without that right?)."
        exec env COHORT_IN_NAMESPACE=1 unshare --mount --propagation private "$0" "$@"
    fi
    trap unmount_all EXIT
    trap 'exit 130' INT
    trap 'exit 143' TERM
}

# lock NAME: one run at a time, as two would make the same root.
lock() {
    mkdir -p "$cache"
    exec 9>"$cache/$1.lock"
    flock 9
}

unmount_all() {
    local i
    for ((i = ${#mounted[@]} - 1; i >= 0; i--)); do
        umount "${mounted[i]}" || umount --lazy "${mounted[i]}" || true
    done
    mounted=()
}

# bind FROM TO [OPTION]: makes a directory of ours visible inside the root.
bind() {
    mkdir -p "$root$2"
    mount --bind "$1" "$root$2"
    mounted+=("$root$2")
    [ -z "${3:-}" ] || mount -o "remount,bind,$3" "$root$2"
}

# mount_system: what programs expect of a running system: processes, devices, terminals (sudo makes them) and shared
# memory of its own.
mount_system() {
    mount -t proc proc "$root/proc"
    mounted+=("$root/proc")
    bind /dev /dev
    bind /dev/pts /dev/pts
    mount -t tmpfs -o mode=1777 tmpfs "$root/dev/shm"
    mounted+=("$root/dev/shm")
}

# inside COMMAND...: runs in the root as $user, with `environment`, `network` and nothing else of our environment; nor
# with our lock, which a process that is left behind would keep.
inside() { env -i "${environment[@]}" "${network[@]}" "$chroot" ${user:+--userspec="$user"} "$root" "$@" 9>&-; }

# The mirror that apt uses here, without its suite.
host_mirror() {
    apt-get indextargets --format '$(SITE) $(RELEASE)' 'Created-By: Packages' 2>/dev/null \
        | awk '$1 ~ /\/debian\/?$/ { print $1; exit }'
}

# configure_network: brings in how the host reaches the net, which may differ from run to run: its resolver, the
# certificates that it trusts, and its variables.
configure_network() {
    cp --dereference /etc/resolv.conf /etc/hosts "$root/etc/"
    local variable certificates=${SSL_CERT_FILE:-/etc/ssl/certs/ca-certificates.crt}
    network=()
    if [ -f "$certificates" ]; then
        mkdir -p "$root/etc/ssl"
        cp --dereference "$certificates" "$root/etc/ssl/host.crt"
        for variable in SSL_CERT_FILE CARGO_HTTP_CAINFO PIP_CERT; do
            network+=("$variable=/etc/ssl/host.crt")
        done
    fi
    for variable in http_proxy https_proxy ftp_proxy no_proxy HTTP_PROXY HTTPS_PROXY NO_PROXY ALL_PROXY \
        CARGO_HTTP_PROXY CARGO_NET_OFFLINE CARGO_BUILD_JOBS \
        PIP_INDEX_URL PIP_EXTRA_INDEX_URL PIP_TRUSTED_HOST PIP_PROXY PIP_RETRIES PIP_DEFAULT_TIMEOUT; do
        [ -z "${!variable:-}" ] || network+=("$variable=${!variable}")
    done
}

# configure_apt SUITE MIRROR: brings in how the host's apt fetches, and names the mirror.
configure_apt() {
    local setting
    for setting in apt.conf.d auth.conf.d; do
        mkdir -p "$root/etc/apt/$setting"
        # Only what tells apt how to fetch: hooks would call programs that are not there.
        find "/etc/apt/$setting" -type f ! -exec grep -qiE 'Invoke|Pre-Install|IndexTargets' {} \; \
            -exec cp {} "$root/etc/apt/$setting/" \;
    done
    [ ! -f /etc/apt/apt.conf ] || cp /etc/apt/apt.conf "$root/etc/apt/"
    echo "deb $2 $1 main" >"$root/etc/apt/sources.list"
    rm -f "$root"/etc/apt/sources.list.d/*
}

# remove_root DIRECTORY: removes a root, unless something is mounted there that we did not mount.
remove_root() {
    if grep -qF " $1" /proc/self/mountinfo; then
        echo "Something is mounted in $1: unmount it first." >&2
        exit 1
    fi
    rm -rf --one-file-system "$1"
}

# make_root NAME SUITE PACKAGE...: makes the root NAME in the cache unless it is there: Debian's minimal system and the
# packages. It is made under another name, so that one whose making was interrupted is never taken for whole;
# `finished` lists the packages, so that a change to them makes a new one.
make_root() {
    local final=$cache/$1 log=$cache/$1.log suite=$2
    shift 2
    root=$final
    if [ "$(cat "$final/finished" 2>/dev/null)" = "$suite $*" ]; then
        return
    fi
    local mirror=${DEBIAN_MIRROR:-$(host_mirror)}
    mirror=${mirror:-http://deb.debian.org/debian}
    echo "Making a root of Debian $suite in $final from $mirror (once)." >&2
    root=$final.new
    remove_root "$final"
    remove_root "$root"
    : >"$log"
    logged debootstrap --variant=minbase "$suite" "$root" "$mirror"
    configure_network
    configure_apt "$suite" "$mirror"
    if [ $# -gt 0 ]; then
        mount_system
        logged inside apt-get update
        logged inside apt-get install --yes --no-install-recommends "$@"
        logged inside apt-get clean
        unmount_all
    fi
    echo "$suite $*" >"$root/finished"
    mv "$root" "$final"
    root=$final
}

# logged COMMAND...: adds what the command says to $log, and ends the script with the last of it if the command fails.
logged() {
    "$@" >>"$log" 2>&1 || {
        tail -n 20 "$log" >&2
        exit 1
    }
}

# bind_rust CHECKOUT: makes the Rust that the host builds the checkout with visible at /rust.
bind_rust() { bind "$(cd "$1" && rustc --print sysroot)" /rust ro; }
