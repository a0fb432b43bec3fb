#!/bin/sh
# For the Makefiles of the three packages, in the folder of the package. It notes what it installs, and asks
# each time whether it is still there, in 0.05 s. Nothing is removed that it did not install.
#     environment.sh install .venv .installed LOCK... [-- FOLDER...]
#                                                    install what differs from the lock files, and the packages of folders
#     environment.sh new .venv                       begin an environment again, empty
#     environment.sh note .venv/.installed LOCK...   note its packages, and the lock files they are from
set -eu

here=$(dirname "$0")
package=$(sed -n '/^name = /{s/^name = "\(.*\)"/\1/p;q}' pyproject.toml)

stop() {
    echo "$1" >&2
    exit 1
}

again() {
    stop "$venv $1. Remove it (rm -r $venv), and give the same command again, which downloads its packages."
}

# Whether it may be written: it has no files yet, or its first one says that make installed it for this package.
ours() {
    [ -e "$venv" ] || [ ! -L "$venv" ] ||
        stop "$venv is a link to $(readlink "$venv"), which does not exist. Remove the link (rm $venv), and give the same command again."
    [ -d "$venv" ] || [ ! -e "$venv" ] || stop "$venv is not a folder. Name another one: make VENV=FOLDER"
    [ -n "$(ls -A "$venv" 2> /dev/null)" ] || return 0
    [ -e "$venv/.package" ] || [ ! -e "$venv/.installed" ] || again "was installed before make noted what it installs"
    [ -e "$venv/.package" ] || stop "$venv has files that make did not install. Name another folder: make VENV=FOLDER"
    read -r owner < "$venv/.package" || true
    [ "$owner" = "$package" ] || stop "$venv is the environment of $owner, not of $package. Name another folder: make VENV=FOLDER"
}

# Print what differs from a note, if anything does.
difference() {
    while read -r noted file; do
        case $noted in
        lib/*)
            distribution=${noted##*/}
            [ -d "$venv/$noted" ] || { echo "no longer has ${distribution%.dist-info}"; return; }
            ;;
        *) [ "$(sha256sum < "$file")" = "$noted  -" ] || { echo "was installed from another $file"; return; } ;;
        esac
    done < "$1"
}

new() {
    ours
    mkdir -p "$venv"
    echo "$package" > "$venv/.package"
    find "$venv/" -mindepth 1 -maxdepth 1 ! -name .package -exec rm -r {} +
    sh "$here/python.sh" -m venv "$venv"
}

note() {
    stamp=$1
    shift
    {
        [ $# = 0 ] || sha256sum "$@"
        (cd "${stamp%/*}" && ls -d lib/python3.*/site-packages/*.dist-info)
    } > "$stamp.part"
    mv "$stamp.part" "$stamp"
}

# Errors only: pip's notices on options that it will change are not for users. If it fails, it has restored
# what was there; if it is killed, the mark stays.
pip() {
    touch "$venv/.installing"
    "$venv/bin/python" -m pip --quiet --quiet --disable-pip-version-check install "$@" || {
        [ $? -gt 128 ] || rm "$venv/.installing"
        exit 1
    }
    rm "$venv/.installing"
}

# End with one line if an environment cannot be mended, with the cure.
usable() {
    [ -e "$venv/.installed" ] && [ ! -e "$venv/.installing" ] || again "was not installed to its end"
    python=$("$venv/bin/python" -ISc 'import sys; print("python%d.%d" % sys.version_info[:2])' 2> /dev/null) ||
        again "has a Python that does not run"
    [ -d "$venv/lib/$python" ] || again "has packages of $(ls "$venv/lib"), and its Python is now $python"
}

install() {
    stamp=$1
    shift
    if [ -e "$venv/.package" ]; then usable; else new; fi
    if [ ! -e "$stamp" ]; then
        echo "Installing into $venv, in about a minute."
    else
        changed=$(difference "$stamp")
        [ -n "$changed" ] || return 0
        echo "$venv $changed: installing what differs."
    fi
    locks=
    while [ $# -gt 0 ] && [ "$1" != -- ]; do
        pip --require-hashes --only-binary :all: --no-build-isolation \
            --no-binary "$(sh "$here/python.sh" --builds "$(ls "$venv/lib")")" --requirement "$1"
        locks="$locks $1"
        shift
    done
    [ $# = 0 ] || shift
    for folder in "$@"; do
        pip --no-deps --no-build-isolation --editable "$folder"
    done
    # Names of lock files have no spaces.
    note "$stamp" $locks
}

command=$1
venv=$2
shift 2
case $command in
new) new ;;
note)
    stamp=$venv
    note "$stamp" "$@"
    ;;
install)
    ours
    stamp=$venv/$1
    shift
    install "$stamp" "$@"
    ;;
esac
