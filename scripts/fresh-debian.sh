#!/usr/bin/env bash
# Proves the two commands of the README on a fresh Debian: in roots that hold Debian's minimal system and nothing else.
#
#   scripts/fresh-debian.sh bookworm|trixie [quickstart|test|both]
#
# `quickstart` runs scripts/quickstart.sh as root, and in another fresh root as a user with sudo; each time twice, and
# the second time must find nothing to install or compile. `test` runs scripts/test.sh as a user with sudo. `both` (the
# default) is all of it, scripts/test.sh where that user has run scripts/quickstart.sh. What runs is a clone of HEAD. Rust is this system's, handed out by a stand-in for
# https://sh.rustup.rs, so that this works where rustup cannot be reached; COHORT_RUSTUP=download takes rustup's own.
#
# It must run as root, with debootstrap, git and Rust at hand. Other variables: COHORT_CACHE, where the minimal systems
# are kept (default ~/.cache/cohort); DEBIAN_MIRROR, where packages come from (default: apt's mirror here);
# COHORT_MODELS and COHORT_SUITE, shown to the tests; COHORT_REFERENCES, a folder with Mitsuba's images from an earlier
# run (target/tmp/mitsuba), which saves the tests making them.
set -euo pipefail

checkout=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/debian-root.sh
. "$checkout/scripts/debian-root.sh"

cannot_run() {
    echo "ERROR: nothing was proven: $1" >&2
    exit 1
}

suite=${1:-}
what=${2:-both}
case "$suite $what" in
    "bookworm quickstart" | "bookworm test" | "bookworm both") ;;
    "trixie quickstart" | "trixie test" | "trixie both") ;;
    *)
        echo "Usage: scripts/fresh-debian.sh bookworm|trixie [quickstart|test|both]" >&2
        exit 2
        ;;
esac

need_root_and cargo git
enter_namespace "$@"
lock "fresh-$suite"
[ -z "$(git -C "$checkout" status --porcelain --untracked-files=no)" ] \
    || echo "NOTE: what runs is HEAD, without the changes here that are not committed." >&2

# What the scripts say, to be looked at here.
log=$cache/fresh-$suite-run.log

# fresh_root: a copy of the minimal system becomes $root.
fresh_root() {
    make_root "fresh-$suite" "$suite"
    local minimal=$root
    root=$cache/fresh-$suite-run
    remove_root "$root"
    cp --archive --reflink=auto "$minimal" "$root"
    configure_network
    mount_system
}

# become_root: the root user, of whom login sets these variables.
become_root() {
    home=/root
    user=
    environment=(PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin "HOME=$home" USER=root LOGNAME=root)
}

# become_user: a user who may use sudo.
become_user() {
    become_root
    logged inside apt-get update
    logged inside env DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends sudo
    # Nobody has asked for lists of packages on a fresh system.
    find "$root/var/lib/apt/lists" -type f -delete
    inside useradd --create-home --shell /bin/bash tester
    echo "tester ALL=(ALL) NOPASSWD: ALL" >"$root/etc/sudoers.d/tester"
    home=/home/tester
    user=tester:tester
    environment=(PATH=/usr/local/bin:/usr/bin:/bin "HOME=$home" USER=tester LOGNAME=tester)
}

# stand_in_for_rustup: puts a `curl` before the real one that answers for https://sh.rustup.rs, with an installer that
# links this system's Rust where rustup would put its own. It checks that both are called as the real ones want it.
stand_in_for_rustup() {
    bind_rust "$checkout"
    cat >"$root/usr/local/bin/curl" <<'END'
#!/bin/sh
set -eu
case "$*" in *" https://sh.rustup.rs") ;; *) exec /usr/bin/curl "$@" ;; esac
# The real one reads the options, and does no more because of the last.
/usr/bin/curl "$@" --version >/dev/null
cat /usr/local/share/rustup-init.sh
END
    cat >"$root/usr/local/share/rustup-init.sh" <<'END'
set -eu
echo "Stand-in for rustup, called with: $*"
case " $* " in *" -y "*) ;; *) echo "rustup would ask, and nobody answers" >&2; exit 1 ;; esac
mkdir -p "$HOME/.cargo/bin"
ln -s /rust/bin/* "$HOME/.cargo/bin/"
END
    chmod 755 "$root/usr/local/bin/curl"
}

# bring_in_pip: how the host's pip fetches.
bring_in_pip() {
    local file
    [ ! -f /etc/pip.conf ] || cp /etc/pip.conf "$root/etc/"
    for file in .config/pip/pip.conf .pip/pip.conf; do
        [ ! -f "$HOME/$file" ] || inside sh -c "mkdir -p ~/${file%/*} && cat >~/$file" <"$HOME/$file"
    done
}

# bring_in_test_data: the models, scenes and references at hand here.
bring_in_test_data() {
    if [ -n "${COHORT_MODELS:-}" ]; then
        bind "$COHORT_MODELS" /srv/models ro
        environment+=(COHORT_MODELS=/srv/models)
    fi
    if [ -n "${COHORT_SUITE:-}" ]; then
        bind "$COHORT_SUITE" /srv/suite ro
        environment+=(COHORT_SUITE=/srv/suite)
    fi
    if [ -n "${COHORT_REFERENCES:-}" ]; then
        # By root, as nobody else may read what a test of root's left.
        inside mkdir -p "$home/cohort/target/tmp"
        cp -r "$COHORT_REFERENCES" "$root$home/cohort/target/tmp/mitsuba"
        give "$home/cohort/target"
    fi
}

# get_sources: a clone of HEAD, in the home of whoever runs it.
get_sources() {
    git clone --quiet --no-hardlinks "$checkout" "$root$home/cohort"
    give "$home/cohort"
}

# give DIRECTORY: makes a directory of the root belong to the user.
give() { [ -z "$user" ] || "$chroot" "$root" chown --recursive "$user" "$1"; }

# run SCRIPT: runs it in the checkout, shows what it says and how long it took, and leaves that in $said.
run() {
    local start=$SECONDS who
    who=$(inside id -un)
    said=$root/said
    echo
    echo "== Debian $(cat "$root/etc/debian_version"), $who: $1"
    inside sh -c 'cd ~/cohort && exec "$1"' sh "$1" 2>&1 </dev/null | tee "$said" | tee -a "$log" \
        | sed -uE '/^(Get:|Selecting |Preparing |Unpacking |Setting up |Processing |\(Reading database)/d'
    echo "== $1 took $((SECONDS - start)) s"
}

# expect PATTERN / expect_not PATTERN: what the last script must, or must not, have said.
expect() { grep -qE "$1" "$said" || { echo "FAILED: it never said: $1" >&2; exit 1; }; }
expect_not() { ! grep -E "$1" "$said" || { echo "FAILED: it said what it should not" >&2; exit 1; }; }

# fresh become_root|become_user: a fresh system with the sources, for that user.
fresh() {
    fresh_root
    "$1"
    [ "${COHORT_RUSTUP:-}" = download ] || stand_in_for_rustup
    get_sources
}

run_quickstart() {
    run scripts/quickstart.sh
    expect "^Installing Debian packages: "
    expect "^Installing Rust by rustup"
    expect "^ +Compiling cohort "
    inside sh -c 'test -s ~/cohort/renders/cornell-knot.exr && test -s ~/cohort/renders/cornell-knot.png'
    run scripts/quickstart.sh
    expect_not "^Installing |^ +Compiling "
}

run_test() {
    bring_in_pip
    bring_in_test_data
    run scripts/test.sh
    awk '/^test result:/ { passed += $4; failed += $6; ignored += $8 }
        END { print "Tests: " passed " passed, " failed " failed, " ignored " ignored" }' "$said"
}

# finish: says what was there, and ends this root.
finish() {
    # shellcheck disable=SC2016
    echo "Embree $(inside dpkg-query -W -f '${Version}' libembree-dev), $(inside sh -c '"$HOME"/.cargo/bin/rustc --version')"
    unmount_all
    remove_root "$root"
}

: >"$log"
if [ "$what" != test ]; then
    fresh become_root
    run_quickstart
    finish
fi
fresh become_user
[ "$what" = test ] || run_quickstart
[ "$what" = quickstart ] || run_test
finish
echo "PASSED: $what on a fresh Debian $suite."
