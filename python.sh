#!/bin/sh
# For the Makefiles of the three packages, in the folder of the package.
#     python.sh -m venv .venv           run a Python that the lock file serves, with these arguments
#     python.sh --builds python3.14     print what has no wheel for this Python: pip builds it from source
# The Python is $PYTHON, or else the first that serves: python3, then those of pyproject.toml, newest first.
set -eu

if [ "$1" = --builds ]; then
    case $2 in
    python3.14) echo connection-pool,immutables ;;
    *) echo connection-pool ;;
    esac
    exit
fi

# requires-python = ">=3.11,<3.15"
oldest=$(sed -n 's/^requires-python = ">=3\.\([0-9]*\),.*/\1/p' pyproject.toml)
newest=$(($(sed -n 's/^requires-python = .*<3\.\([0-9]*\)"/\1/p' pyproject.toml) - 1))

# immutables is written in C; connection-pool is not.
must_compile() {
    grep -q '^immutables==' requirements.lock && sh "$0" --builds "$1" | grep -q immutables
}

can_compile() {
    compiler=$("$1" -c 'import sysconfig; print(sysconfig.get_config_var("CC"))')
    headers=$("$1" -c 'import sysconfig; print(sysconfig.get_path("include"))')
    echo '#include <Python.h>' | $compiler -I"$headers" -fsyntax-only -x c - 2> /dev/null
}

# Print why a Python does not serve, and what to do.
trouble() {
    version=$("$1" -c 'import sys; print("python%d.%d" % sys.version_info[:2])' 2> /dev/null) || version=missing
    minor=${version#python3.}
    if [ "$minor" = "$version" ] || [ "$minor" -lt "$oldest" ] || [ "$minor" -gt "$newest" ]; then
        echo "$1 is ${version#python}: install Python 3.$oldest to 3.$newest"
        return
    fi
    packages=
    "$1" -c 'import ensurepip, venv' 2> /dev/null || packages=" $version-venv"
    if must_compile "$version" && ! can_compile "$1"; then
        packages="$packages gcc $version-dev"
    fi
    [ -z "$packages" ] || echo "$1 needs what Debian and Ubuntu call$packages: install it"
}

found=
others=$(seq --format python3.%g "$newest" -1 "$oldest")
for python in ${PYTHON:-python3 $others}; do
    reason=$(trouble "$python")
    if [ -z "$reason" ]; then
        [ -z "$found" ] || echo "${found%%: *}, so $python is taken." >&2
        exec "$python" "$@"
    fi
    found=${found:-$reason}
done
echo "$found, or name another Python with make PYTHON=python3.13, or use conda (environment.yml)." >&2
exit 1
