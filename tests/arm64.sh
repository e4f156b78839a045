#!/usr/bin/env bash
# Builds the core for ARM64 on a Debian 12 machine of another kind and runs its tests under emulation, the kernels of
# NEON among them; then bakes a scene with both builds of `tss`, which must write the same bytes, and asks its table at
# the same poses, which must have the same answers. Libraries for ARM64 are unpacked below build-arm64/, the system gets a compiler and an emulator only.
#   tests/arm64.sh [--tests FOLDER...]   the tests of these folders alone (default: table motion respond search verify)
set -euo pipefail
cd "$(dirname "$0")/.."
source tests/setup.sh

folders=(table motion respond search verify)
both=yes
if [ "${1:-}" = --tests ]; then
    shift
    folders=("$@")
    both=
fi
build=$PWD/build-arm64 root=$PWD/build-arm64/root
libraries=(libeigen3-dev libfmt-dev libtbb-dev nlohmann-json3-dev libhwy-dev libcli11-dev libtinyxml2-dev libfcl-dev catch2)

packages_arm64=(cmake ninja-build g++-aarch64-linux-gnu qemu-user-static)
install_packages arm64

# apt with lists, cache and architecture of its own.
unpack_libraries() {
    local apt=$build/apt
    [ ! -e "$root/complete" ] || return 0
    mkdir -p "$apt/lists/partial" "$apt/cache/archives/partial" "$root"
    : >"$apt/status"
    cat >"$apt/apt.conf" <<END
APT::Architecture "arm64";
APT::Architectures { "arm64"; };
Dir::State "$apt";
Dir::State::lists "$apt/lists";
Dir::State::status "$apt/status";
Dir::Cache "$apt/cache";
APT::Sandbox::User "";
END
    APT_CONFIG=$apt/apt.conf apt-get update -q
    APT_CONFIG=$apt/apt.conf apt-get install -y -q --no-install-recommends --download-only "${libraries[@]}"
    for package in "$apt"/cache/archives/*.deb; do dpkg-deb -x "$package" "$root"; done
    touch "$root/complete"
}

configure() {
    cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_TOOLCHAIN_FILE="$PWD/tests/arm64.cmake" \
        -DARM64_ROOT="$root" -DOSGTSS_NODEKIT=OFF -DOSGTSS_EXAMPLES=OFF -DOSGTSS_IMPORT=OFF -DOSGTSS_URDF=OFF \
        -DOSGTSS_TESTS=ON -DOSGTSS_WERROR="$([ -n "${CI:-}" ] && echo ON || echo OFF)"
}

compile() {
    local targets=("${folders[@]/#/test_}")
    [ -z "$both" ] || targets+=(tss)
    cmake --build "$build" --parallel "$(nproc)" --target "${targets[@]}"
}

run_tests() {
    local names
    names=$(IFS='|' && echo "${folders[*]}")
    ctest --test-dir "$build" --output-on-failure --timeout 9000 -R "^($names)$"
}

# What both builds of tss make of one scene and say about it.
same_bytes() {
    local here=build/bin/tss there work
    there=(qemu-aarch64-static -L "$root" -E "LD_LIBRARY_PATH=$root/usr/lib/aarch64-linux-gnu" "$build/bin/tss")
    work=$(mktemp -d)
    "$here" make --body examples/hinge/lower.obj --body examples/hinge/upper.obj \
        --joint "swing=lower,upper:rot:0,0,0:0,1,0:0:60" -o "$work/scene.tss"
    "$here" bake "$work/scene.tss" -o "$work/here.tss"
    "${there[@]}" bake "$work/scene.tss" -o "$work/there.tss"
    cmp "$work/here.tss" "$work/there.tss"
    "$here" query "$work/here.tss" --poses examples/hinge/poses.csv -o "$work/here.csv"
    "${there[@]}" query "$work/there.tss" --poses examples/hinge/poses.csv -o "$work/there.csv"
    # Gap, verdict and test to the byte; places and directions, in which C++ libraries round apart, to 12 digits.
    cmp <(cut -d, -f1-3 "$work/here.csv") <(cut -d, -f1-3 "$work/there.csv")
    paste -d, "$work/here.csv" "$work/there.csv" | awk -F, '
        NR > 1 { for (k = 4; k <= 9; ++k) {
            off = $k - $(k + 9); most = 1e-12 * (1 + ($k < 0 ? -$k : $k))
            if (off > most || -off > most) { print "line " NR ", column " k ": " $k " and " $(k + 9); wrong = 1 } } }
        END { exit wrong }'
    rm -r "$work"
    echo "the same table and the same answers"
}

parts "libraries for ARM64=1" "setting up=1" "building=12" "tests under emulation=90" ${both:+"one bake on both=2"}
part "libraries for ARM64" unpack_libraries
part "setting up" configure
part "building" compile
keep_going
part "tests under emulation" run_tests
[ -z "$both" ] || part "one bake on both" same_bytes
verdict
