# shellcheck shell=bash
# Stamps: what a finished step was made from. Sourced by setup.sh.
#
# A stamp is a file in the virtual environment (`venv`, from release.sh) that holds the key (a
# hash of all inputs) of the step that wrote it. It is written last, so an interrupted step has
# none and is done again.

# key_of TEXT... -- FILE...: a hash of the texts, the files' names and the files' contents.
key_of() {
    local texts=()
    while (($#)) && [[ $1 != -- ]]; do
        texts+=("$1")
        shift
    done
    shift
    {
        if ((${#texts[@]})); then printf '%s\n' "${texts[@]}"; fi
        if (($#)); then sha256sum -- "$@"; fi
    } | sha256sum | cut -c 1-32
}

# stamp_is NAME KEY: true if step NAME is finished and was made from these inputs.
stamp_is() {
    [[ -f $venv/.stamp-$1 && $(<"$venv/.stamp-$1") == "$2" ]]
}

write_stamp() {
    printf '%s\n' "$2" >"$venv/.stamp-$1"
}

drop_stamp() {
    rm -f "$venv/.stamp-$1"
}
