# What a build, the pictures, the report and the tests need on Debian 12, and how their progress is told; sourced by
# examples/run.sh, tests/run.sh and tests/coverage.sh.
#   install_packages GROUP...                installs what is missing of these groups, with apt, as root or through sudo
#   build_release OPTION... [-- TARGET...]   builds into build/ (preset release); without targets, all
#   parts NAME=MINUTES...                    what is to come, and how long it takes on two quiet cores: for the time left
#   part NAME COMMAND...                     runs one of them, saying so; the first failure ends the script, or, after
#                                            keep_going, is remembered for verdict

packages_build=(
    build-essential cmake ninja-build pkg-config file
    libopenscenegraph-dev libegl-dev
    libeigen3-dev libassimp-dev libminizip-dev nlohmann-json3-dev
    libtbb-dev libhwy-dev libcli11-dev libfmt-dev zlib1g-dev
    liburdfdom-dev liburdfdom-headers-dev libtinyxml2-dev
)
packages_pictures=(openscenegraph xvfb xauth libgl1-mesa-dri libegl-mesa0)
packages_report=(libfcl-dev libbullet-dev libcgal-dev libpng-dev gnuplot-nox)
packages_tests=(catch2 libfcl-dev libmujoco-dev parallel help2man)
packages_api=(doxygen)
packages_fuzz=(clang libclang-rt-14-dev)
packages_browser=(chromium)

# Options of what a scene that is there needs nothing of: the report, and readers of others' files.
later_parts=(-DOSGTSS_REPORT -DOSGTSS_URDF -DOSGTSS_MJCF -DOSGTSS_USDA)

say() { printf '\n== %s\n' "$*"; }

install_packages() {
    local group package missing=() wanted become=()
    for group in "$@"; do
        wanted=packages_$group[@]
        for package in "${!wanted}"; do
            dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null | grep -q '^installed$' || missing+=("$package")
        done
    done
    [ ${#missing[@]} -gt 0 ] || return 0
    say "Installing ${missing[*]}"
    [ "$(id -u)" -eq 0 ] || become=(sudo)
    "${become[@]}" apt-get update -q
    "${become[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}"
}

# Warnings are errors in continuous integration.
build_release() {
    local options=() log
    while [ $# -gt 0 ] && [ "$1" != -- ]; do
        options+=("$1")
        shift
    done
    [ $# -eq 0 ] || { shift; set -- --target "$@"; }
    log=$(cmake --preset release -DOSGTSS_WERROR="$([ -n "${CI:-}" ] && echo ON || echo OFF)" "${options[@]}" 2>&1) || {
        printf '%s\n' "$log" >&2
        return 1
    }
    NINJA_STATUS='@ %f %t %e @' cmake --build --preset release --parallel "$(nproc)" "$@" | tell_build
}

# Ninja's lines become how many steps are done and how long the others will take; all else is shown as it is.
tell_build() {
    local terminal=0
    [ ! -t 1 ] || terminal=1
    awk -v terminal="$terminal" '
        /^@ / {
            if ($4 - last >= (terminal ? 1 : 20) || $2 == $3) {
                last = $4
                left = $2 ? ($3 - $2) * $4 / $2 / 60 : 0
                printf "%s%d of %d steps, %.1f min, about %.1f min left%s", terminal ? "\r\033[K" : "", $2, $3, $4 / 60, left,
                       terminal && $2 < $3 ? "" : "\n"
                fflush()
            }
            next
        }
        /^ninja: no work to do/ { next }
        { print; fflush() }'
}

declare -A part_minutes
part_names=() part_passed=() part_failed=() part_skipped=()
part_number=0 part_keep=""
minutes_since() { awk -v s=$((SECONDS - $1)) 'BEGIN { printf "%.1f min", s / 60 }'; }

parts() {
    local each
    started=$SECONDS
    for each in "$@"; do
        part_names+=("${each%=*}")
        part_minutes[${each%=*}]=${each##*=}
    done
}

keep_going() { part_keep=yes; }

# What the parts to come take, by what those done took on this machine.
left_after() {
    local k behind=0 ahead=0
    for k in "${!part_names[@]}"; do
        if [ "$k" -lt "$1" ]; then
            behind="$behind+${part_minutes[${part_names[$k]}]}"
        else
            ahead="$ahead+${part_minutes[${part_names[$k]}]}"
        fi
    done
    # A part that had next to nothing to do, as it was done before, says nothing of the machine.
    awk -v took=$((SECONDS - started)) \
        "BEGIN { b = $behind; a = $ahead; m = took / 60; printf \"%.0f\", (m > b ? a * m / b : a) }"
}

# A command that ends with 77 was skipped, and has said why.
part() {
    local name=$1 rc=0 before=$SECONDS
    shift
    say "Part $((part_number + 1)) of ${#part_names[@]}: $name (all that is left: about $(left_after "$part_number") min)"
    part_number=$((part_number + 1))
    if [ -z "$part_keep" ]; then
        "$@"
        return
    fi
    # In a shell of its own, where the first failure ends it.
    set +e
    (set -e; "$@")
    rc=$?
    set -e
    case $rc in
    0) part_passed+=("$name, $(minutes_since "$before")") ;;
    77) part_skipped+=("$name") ;;
    *) part_failed+=("$name, exit $rc") ;;
    esac
}

# One line a part, and the last says it all.
verdict() {
    local each
    say "Verdict after $(minutes_since "$started")"
    for each in "${part_passed[@]}"; do echo "passed   $each"; done
    for each in "${part_skipped[@]}"; do echo "skipped  $each"; done
    for each in "${part_failed[@]}"; do echo "FAILED   $each"; done
    if [ ${#part_failed[@]} -eq 0 ]; then
        echo "ALL PASSED"
    else
        echo "FAILED: ${#part_failed[@]} of $part_number"
        return 1
    fi
}
