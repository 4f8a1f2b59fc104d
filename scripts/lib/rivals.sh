# shellcheck shell=bash disable=SC2154
# The libraries that `make bench` measures beside. Sourced by setup.sh; uses steps.sh.
#
# Each is installed if it can be: what is missing, the report says. Tried again by the next
# `make bench`, until all are there.

do_rivals() {
    choose_constraints
    run_step 'Libraries to measure beside (those that can be had)' install_rivals
    if [[ -f $venv/.rivals-missing ]]; then
        say "      not installed: $(paste -s -d ' ' "$venv/.rivals-missing") (why: $setup_log)"
    else
        write_stamp rivals "$key_rivals"
    fi
}

# rival_requirements: the lines of bench.in that name a package.
rival_requirements() {
    sed -e 's/#.*//' -e '/^[[:space:]]*$/d' requirements/bench.in
}

install_rivals() {
    local line
    rm -f "$venv/.rivals-missing"
    # A pip that is stopped in the middle leaves the mark: see install_packages.
    touch "$venv/.installing"
    while read -r line; do
        # The file is also the constraint: frax would take the newest JAX.
        "$venv/bin/python" -m pip --disable-pip-version-check install --no-input \
            "${constraints[@]}" -c requirements/bench.in "$line" </dev/null ||
            echo "${line%%==*}" >>"$venv/.rivals-missing"
    done < <(rival_requirements)
    rm -f "$venv/.installing"
    install_kdl || echo PyKDL >>"$venv/.rivals-missing"
}

# PyKDL comes from Debian and Ubuntu, built for their own Python: it gets an environment of its
# own, with what this library needs, below `venv`. Nothing is installed into the system.
install_kdl() {
    local python=/usr/bin/python3 lock folder minor library program package code=0
    if "$venv/bin/python" -c 'import PyKDL' 2>/dev/null || kdl_works; then
        return 0
    fi
    for program in apt-get apt-cache dpkg-deb "$python"; do
        command -v "$program" >/dev/null ||
            { echo "PyKDL: expected the program $program, found none."; return 1; }
    done
    minor=$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
    lock=requirements/lock/python$minor.txt
    [[ -f $lock ]] || { echo "PyKDL: expected $lock for $python, found none."; return 1; }
    library=$(apt-cache depends python3-pykdl 2>/dev/null |
        sed -n 's/.*Depends: \(liborocos-kdl[0-9.]*\)$/\1/p' | head -n 1)
    [[ -n $library ]] || { echo 'PyKDL: apt knows no python3-pykdl: apt-get update?'; return 1; }
    folder=$(mktemp -d)
    (cd "$folder" && apt-get download python3-pykdl "$library" &&
        for package in *.deb; do dpkg-deb -x "$package" .; done) &&
        rm -rf "$venv/kdl" && "$python" -m venv "$venv/kdl" &&
        "$venv/kdl/bin/python" -m pip --disable-pip-version-check install --no-input \
            -c "$lock" -r requirements/runtime.in </dev/null &&
        cp "$folder"/usr/lib/python3/dist-packages/PyKDL*.so \
            "$venv/kdl/lib/python$minor/site-packages/" &&
        cp -P "$folder"/usr/lib/*/liborocos-kdl.so.* "$venv/kdl/lib/" &&
        kdl_works || code=1
    rm -rf "$folder"
    return $code
}

kdl_works() {
    LD_LIBRARY_PATH=$PWD/$venv/kdl/lib PYTHONPATH=$PWD \
        "$venv/kdl/bin/python" -c 'import PyKDL, dynamics_node' 2>/dev/null
}
