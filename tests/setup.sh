# What a build, the pictures, the report and the tests need on Debian 12; sourced by tests/run.sh and examples/run.sh.
# install_packages <group>... installs what is missing of these groups, with apt, as root or through sudo;
# build_release <option>... -- <target>... builds into build/.

packages_build=(
    build-essential cmake ninja-build pkg-config file
    libopenscenegraph-dev openscenegraph
    libeigen3-dev libassimp-dev nlohmann-json3-dev
    libtbb-dev libhwy-dev libcli11-dev libfmt-dev zlib1g-dev
    libegl-dev
)
packages_pictures=(xvfb xauth libgl1-mesa-dri libegl-mesa0)
packages_report=(libfcl-dev libbullet-dev libcgal-dev gnuplot-nox)
packages_tests=(
    catch2 libfcl-dev parallel help2man
    clang libclang-rt-14-dev
    doxygen
)

say() { printf '\n== %s\n' "$*"; }

install_packages() {
    local group package missing=() wanted
    for group in "$@"; do
        wanted=packages_$group[@]
        for package in "${!wanted}"; do
            dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null | grep -q '^installed$' || missing+=("$package")
        done
    done
    if [ ${#missing[@]} -eq 0 ]; then
        say "All Debian packages for $* are there"
        return
    fi
    say "Installing ${missing[*]}"
    local become=()
    [ "$(id -u)" -eq 0 ] || become=(sudo)
    "${become[@]}" apt-get update -q
    "${become[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}"
}

# Options for cmake, then -- and targets (none: all). Warnings are errors in continuous integration.
build_release() {
    local options=() targets=()
    while [ $# -gt 0 ] && [ "$1" != -- ]; do
        options+=("$1")
        shift
    done
    [ $# -eq 0 ] || { shift; targets=(--target "$@"); }
    cmake --preset release -DOSGTSS_WERROR="$([ -n "${CI:-}" ] && echo ON || echo OFF)" "${options[@]}" >build.log 2>&1 || {
        cat build.log >&2
        rm -f build.log
        return 1
    }
    rm -f build.log
    # Elapsed seconds stand beside what is done and what there is to do.
    NINJA_STATUS='[%f/%t, %es] ' cmake --build --preset release --parallel "$(nproc)" "${targets[@]}"
}
