# shellcheck shell=bash
# Numbered steps with elapsed time. Sourced by setup.sh.
#
# A step's own output goes to a log file. Meanwhile its last line is shown: on a terminal in
# one line that is rewritten, elsewhere every ten seconds. If the step fails, the end of its
# output is printed.

setup_log=log/setup.log
step_number=0
step_count=0

# begin_steps COUNT: start a new log.
begin_steps() {
    step_number=0
    step_count=$1
    mkdir -p log
    touch log/COLCON_IGNORE
    : >"$setup_log"
}

# last_line: what the running step said last, without warnings and progress bars.
last_line() {
    tail -n 20 "$setup_log" | sed 's/\x1b\[[0-9;]*m//g' | tr -d '\000-\011\013-\037' |
        awk '/^== / {line = ""; next} /WARNING|^  / {next} {line = $0} END {print line}'
}

# has_said TEXT: true if a line of the running step begins with this text.
has_said() {
    awk -v text="$1" '/^== / {said = 0} index($0, text) == 1 {said = 1} END {exit !said}' "$setup_log"
}

# A step may name another function that says how far it is.
describe_progress=last_line

# detail WIDTH: the same, fit for one line.
detail() {
    "$describe_progress" 2>/dev/null | cut -c "1-$1"
}

# report_progress TITLE: runs beside a step until it is ended, or until its parent is gone.
report_progress() {
    local title=$1 begin=$SECONDS pause=10 width=100 line
    if [[ -t 1 ]]; then
        pause=1
        width=$(($(tput cols 2>/dev/null || echo 80) - ${#title} - 18))
        ((width > 10)) || width=10
    fi
    # A sleep that is left over must not keep the output open.
    while sleep "$pause" >/dev/null 2>&1 && kill -0 $$ 2>/dev/null; do
        if [[ -t 1 ]]; then
            printf '\r%s  %d s  %s\033[K' "$title" $((SECONDS - begin)) "$(detail "$width")"
        else
            line=$(detail "$width")
            printf '      %d s%s\n' $((SECONDS - begin)) "${line:+: $line}"
        fi
    done
}

stop_reporter() {
    if [[ -n ${reporter:-} ]]; then
        kill "$reporter" 2>/dev/null || true
        wait "$reporter" 2>/dev/null || true
        reporter=
    fi
}
trap stop_reporter EXIT
# A trap runs with the output of the step that it interrupts, which is the log.
exec 8>&1
trap 'printf "\nInterrupted: run the same command again to go on.\n" >&8; exit 130' INT

# run_step TITLE COMMAND...: ends the script if the command fails.
run_step() {
    local title begin=$SECONDS first_line code=0
    step_number=$((step_number + 1))
    title="[$step_number/$step_count] $1"
    shift
    first_line=$(($(wc -l <"$setup_log") + 1))
    printf '%s\n' "== $title" >>"$setup_log"

    if [[ -t 1 ]]; then printf '%s' "$title"; else printf '%s\n' "$title"; fi
    # The reporter must not hold the lock (file descriptor 9) if it outlives this script.
    report_progress "$title" 8>&- 9<&- &
    reporter=$!
    "$@" >>"$setup_log" 2>&1 </dev/null || code=$?
    stop_reporter

    if ((code)); then
        printf '\n'
        tail -n "+$((first_line + 1))" "$setup_log" | tail -n 30 | cut -c 1-300 >&2
        die "step '${title#*] }' failed with exit code $code; the lines above are the end of" \
            "its output, all of it is in $setup_log; after the cure run the same command again."
    fi
    if [[ -t 1 ]]; then
        printf '\r%s: %d s\033[K\n' "$title" $((SECONDS - begin))
    else
        printf '      done in %d s\n' $((SECONDS - begin))
    fi
}
