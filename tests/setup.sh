# What a build, the tests and the pictures need on Debian 12; sourced by tests/run.sh and examples/run.sh.
# install_packages installs what is missing, with apt, as root or through sudo; build_release builds into build/.

packages=(
    build-essential cmake ninja-build pkg-config file
    libopenscenegraph-dev openscenegraph
    libeigen3-dev libassimp-dev nlohmann-json3-dev catch2
    libtbb-dev libhwy-dev libcli11-dev libfmt-dev
    libfcl-dev zlib1g-dev parallel
    liburdfdom-dev liburdfdom-headers-dev libtinyxml2-dev
    clang libclang-rt-14-dev
    libbullet-dev libcgal-dev gnuplot-nox
    doxygen help2man
    xvfb xauth libgl1-mesa-dri libegl-dev libegl-mesa0
)

say() { printf '\n== %s\n' "$*"; }

install_packages() {
    local missing=() package
    for package in "${packages[@]}"; do
        dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null | grep -q '^installed$' || missing+=("$package")
    done
    if [ ${#missing[@]} -eq 0 ]; then
        say "All Debian packages are there"
        return
    fi
    say "Installing ${missing[*]}"
    local become=()
    [ "$(id -u)" -eq 0 ] || become=(sudo)
    "${become[@]}" apt-get update -q
    "${become[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}"
}

# The preset `release` with the comparison report into build/; warnings are errors in continuous integration.
build_release() {
    say "Building the preset release into build/"
    cmake --preset release -DOSGTSS_REPORT=ON -DOSGTSS_WERROR="$([ -n "${CI:-}" ] && echo ON || echo OFF)"
    cmake --build --preset release --parallel "$(nproc)"
}
