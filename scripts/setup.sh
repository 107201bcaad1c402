#!/usr/bin/env bash
# Makes .venv with everything MintPilot needs; does nothing when nothing changed.
#
#   scripts/setup.sh run   what it takes to fly and to plan
#   scripts/setup.sh dev   the developer's tools as well
#
# System libraries are installed where that is allowed; otherwise the command for the administrator is printed.

set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly LEVEL=${1:-dev}
readonly VENV=.venv
readonly GL_PACKAGES="libegl1 libegl-mesa0 libgl1-mesa-dri"
readonly BROWSER=chromium # for the tests of the web page
readonly GL_SPARE=libosmesa6 # a second way to draw; newer systems have it no more

case $LEVEL in
    run) EXTRAS=sim,console ;;
    dev) EXTRAS=sim,dev,bench,docs ;;
    *) echo "setup: '$LEVEL' must be run or dev" >&2; exit 2 ;;
esac

say() { echo "setup: $*" >&2; }

# Prints the words that run a command as administrator; fails where that is not allowed.
as_root() {
    if [ "$(id -u)" -eq 0 ]; then echo env
    elif command -v sudo >/dev/null && sudo -n true 2>/dev/null; then echo "sudo env"
    else return 1
    fi
}

# Installs those of the named Debian packages that exist; fails where that is not possible.
apt_install() {
    local root
    command -v apt-get >/dev/null && root=$(as_root) || return 1
    $root apt-get update -qq >/dev/null 2>&1 || true
    local package known=()
    for package in "$@"; do
        if apt-cache show "$package" >/dev/null 2>&1; then known+=("$package"); fi
    done
    [ ${#known[@]} -gt 0 ] || return 1
    say "installing ${known[*]}"
    $root DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${known[@]}" >/dev/null 2>&1
}

find_python() {
    local python
    for python in ${PYTHON:-} python3 python3.14 python3.13 python3.12 python3.11; do
        if "$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then
            command -v "$python"
            return
        fi
    done
    return 1
}

# Software drawing without a screen. Missing libraries do not stop the set-up: planning works without them.
install_gl() {
    command -v dpkg-query >/dev/null || return 0
    local package missing=()
    for package in $GL_PACKAGES; do
        dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
    done
    [ ${#missing[@]} -gt 0 ] || return 0
    apt_install "${missing[@]}" "$GL_SPARE" \
        || say "flying in MuJoCo needs system libraries; ask your administrator for: sudo apt-get install -y ${missing[*]}"
}

# A browser for the developer's tests. Without it they are skipped.
install_browser() {
    [ "$LEVEL" = dev ] && [ ! -x /usr/bin/chromium ] || return 0
    apt_install "$BROWSER" || say "the tests of the web page need a browser; ask your administrator for: sudo apt-get install -y $BROWSER"
}

make_venv() {
    local python version
    if ! python=$(find_python); then
        apt_install python3 python3-venv || true
        python=$(find_python) || { say "Python 3.11 or newer is missing; install it: sudo apt-get install -y python3 python3-venv"; exit 3; }
    fi
    version=$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
    if ! "$python" -c 'import ensurepip, venv' 2>/dev/null; then
        apt_install "python$version-venv" || apt_install python3-venv || true
        if ! "$python" -c 'import ensurepip, venv' 2>/dev/null; then
            say "Python cannot make virtual environments; ask your administrator for: sudo apt-get install -y python$version-venv"
            exit 3
        fi
    fi
    say "making $VENV with Python $version"
    rm -rf "$VENV"
    "$python" -m venv "$VENV"
}

# What an environment was made for; a change of it means installing again.
fingerprint() {
    { cat pyproject.toml scripts/setup.sh; pwd; "$VENV/bin/python" -V; } | cksum
}

is_current() {
    local level
    for level in "$LEVEL" dev; do
        [ -f "$VENV/.made-for-$level" ] && [ "$(cat "$VENV/.made-for-$level")" = "$(fingerprint)" ] && return 0
    done
    return 1
}

if [ -x "$VENV/bin/python" ] && "$VENV/bin/python" -c '' 2>/dev/null; then
    is_current && exit 0
else
    make_venv
fi
install_gl
install_browser
say "installing MintPilot and what it needs (a minute or two the first time)"
if ! "$VENV/bin/python" -m pip install --quiet --quiet --disable-pip-version-check -e ".[$EXTRAS]"; then
    say "pip could not install the packages; check the network or the package index, then run make setup again"
    exit 3
fi
say "compiling the search (kept for later runs)"
compile() {
    "$VENV/bin/python" -m compileall -q src
    "$VENV/bin/python" -c "from mintpilot.planning.warm import warm_up; warm_up()" \
        && "$VENV/bin/mintpilot" plan examples/my-building/mission.yaml
}
compile >/dev/null 2>&1 || say "the example could not be planned; mintpilot doctor says more"
fingerprint > "$VENV/.made-for-$LEVEL"
say "done"
