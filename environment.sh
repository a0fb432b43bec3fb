#!/bin/sh
# For the Makefiles of the three packages, in the folder of the package. `make` notes what it installs,
# and asks each time whether it is still there, in 0.05 s. Nothing is removed that it did not install.
#     environment.sh check .venv                     end with one line if .venv is not what it was, with the cure
#     environment.sh new .venv                       begin it again, empty
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

unchanged() {
    while read -r noted file; do
        case $noted in
        lib/*)
            distribution=${noted##*/}
            [ -d "$venv/$noted" ] || again "no longer has ${distribution%.dist-info}"
            ;;
        *) [ "$(sha256sum < "$file")" = "$noted  -" ] || again "was installed from another $file" ;;
        esac
    done < "$1"
}

case $1 in
new)
    venv=$2
    ours
    mkdir -p "$venv"
    echo "$package" > "$venv/.package"
    find "$venv/" -mindepth 1 -maxdepth 1 ! -name .package -exec rm -r {} +
    exec sh "$here/python.sh" -m venv "$venv"
    ;;
note)
    stamp=$2
    shift 2
    {
        [ $# = 0 ] || sha256sum "$@"
        (cd "${stamp%/*}" && ls -d lib/python3.*/site-packages/*.dist-info)
    } > "$stamp.part"
    mv "$stamp.part" "$stamp"
    ;;
check)
    venv=$2
    ours
    [ -e "$venv/.package" ] || exit 0
    [ -e "$venv/.installed" ] || again "was not installed to its end"
    python=$("$venv/bin/python" -ISc 'import sys; print("python%d.%d" % sys.version_info[:2])' 2> /dev/null) ||
        again "has a Python that does not run"
    [ -d "$venv/lib/$python" ] || again "has packages of $(ls "$venv/lib"), and its Python is now $python"
    for stamp in "$venv/.installed" "$venv/.developing" "$venv/.docs"; do
        [ ! -e "$stamp" ] || unchanged "$stamp"
    done
    ;;
esac
