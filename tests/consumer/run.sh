#!/usr/bin/env bash
# Installs a build into a prefix of its own, builds the project beside this script against it twice, with find_package
# and with pkg-config, and runs both; then the same with the core alone, which brings no OpenSceneGraph along.
# Arguments: the build folder, a scene with a table and two degrees of freedom.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=$1 scene=$2
work=$build/consumer
rm -rf "$work"
mkdir -p "$work"
cmake --install "$build" --prefix "$work/prefix" >"$work/install.log"

echo "uninstalled, from where DESTDIR says"
DESTDIR=$work/staged cmake --install "$build" --prefix "$work/nowhere" >"$work/install.log"
uninstall() { cmake -D BINARY_DIR="$build" -P "$here/../../osgTSS/package/uninstall.cmake" >"$work/uninstall.log" 2>&1; }
if uninstall; then
    echo "uninstalled without DESTDIR"
    exit 1
fi
DESTDIR=$work/staged uninstall
[ -z "$(find "$work/staged" -not -type d)" ]

# Moved, so that nothing in it may name the place it was installed to.
mv "$work/prefix" "$work/moved"
prefix=$work/moved
libraries=$(dirname "$(find "$prefix" -name libosgTSS.so)")
unset OSG_LIBRARY_PATH LD_LIBRARY_PATH
export OSG_LIBRARY_PATH
OSG_LIBRARY_PATH=$(dirname "$(find "$prefix" -name osgdb_tss.so)")

echo "with find_package"
cmake -S "$here" -B "$work/cmake" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_BUILD_TYPE=Release >"$work/configure.log"
cmake --build "$work/cmake" >"$work/build.log" || { cat "$work/build.log"; exit 1; }
"$work/cmake/consumer" "$scene"

echo "with pkg-config"
export PKG_CONFIG_PATH=$libraries/pkgconfig
[ "$(pkg-config --variable=plugindir osgTSS)" -ef "$OSG_LIBRARY_PATH" ]
# Every public header on its own line, and none that needs another before it.
headers=$(cd "$prefix/include" && printf '#include <%s>\n' osgTSS/*)
c++ -std=c++20 -Wall -Wextra -Werror -fsyntax-only -x c++ - $(pkg-config --cflags osgTSS) <<<"$headers"
# What an application needs that does not look into a model does with C++17.
headers=$(grep -vE '/(Convert|SkinGeometry)>' <<<"$headers")
c++ -std=c++17 -Wall -Wextra -Werror -fsyntax-only -x c++ - $(pkg-config --cflags osgTSS) <<<"$headers"
c++ -std=c++20 -O1 "$here/main.cpp" -o "$work/consumer" $(pkg-config --cflags --libs osgTSS)
LD_LIBRARY_PATH=$libraries "$work/consumer" "$scene"

echo "the installed examples, all that the installed documents name"
documents=$(dirname "$(find "$prefix" -name LICENSE)")
for example in $(grep -rohP '\bexamples/[a-z]+(?![a-z.])' "$documents" | sort -u); do
    # Makes the repository's scenes, and is not installed.
    if [ ! -d "$documents/$example" ] && [ "$example" != examples/doghead ]; then
        echo "$example is not installed"
        exit 1
    fi
done
cmake -S "$documents/examples" -B "$work/examples" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_BUILD_TYPE=Release \
      >"$work/configure.log"
cmake --build "$work/examples" >"$work/build.log" || { cat "$work/build.log"; exit 1; }
"$work/examples/bin/example_core" "$scene" 0 0.1
"$work/examples/bin/example_contacts" "$scene" 10 >/dev/null

noOsg() {
    if ldd "$1" | grep libosg | grep -v libosgTSSCore; then
        echo "$1 loads OpenSceneGraph"
        exit 1
    fi
}
example=$here/../../examples/core/main.cpp

echo "the core, with find_package"
cmake -S "$here/core" -B "$work/core" -DCMAKE_PREFIX_PATH="$prefix" -DEXAMPLE="$example" \
      -DCMAKE_BUILD_TYPE=Release >"$work/configure.log"
cmake --build "$work/core" >"$work/build.log" || { cat "$work/build.log"; exit 1; }
"$work/core/consumer_core" "$scene" 0 0.1
noOsg "$work/core/consumer_core"

echo "the core, with pkg-config"
c++ -std=c++20 -O1 "$example" -o "$work/consumer_core" $(pkg-config --cflags --libs osgTSSCore)
LD_LIBRARY_PATH=$libraries "$work/consumer_core" "$scene" 0 0.1
LD_LIBRARY_PATH=$libraries noOsg "$work/consumer_core"
