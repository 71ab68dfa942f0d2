#!/usr/bin/env bash
# Installs the built library somewhere, and builds and runs the examples as someone else's projects, with what the documentation says
# and nothing of this source tree. SPDX-License-Identifier: MIT
#     stranger.sh BUILD_FOLDER SOURCE_FOLDER
set -euo pipefail
build=$1 source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/installed" >/dev/null
cp -r "$source/apps/examples" "$work/examples"
cd "$work"
library=$(dirname "$(find installed -name 'libvesper-c.so')")
export LD_LIBRARY_PATH=$work/$library PKG_CONFIG_PATH=$work/$library/pkgconfig

echo "== whole engine: find_package"
cat >ground.gltf <<'GLTF'
{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2}]}],
 "buffers": [{"byteLength": 108, "uri": "data:application/octet-stream;base64,AACgwQAAAAAAAKBBAACgQQAAAAAAAKBBAACgQQAAAAAAAKDBAACgwQAAAAAAAKDBAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAAAAAABAAIAAAACAAMA"}],
 "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 48}, {"buffer": 0, "byteOffset": 96, "byteLength": 12}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-20, 0, -20], "max": [20, 0, 20]},
               {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3"}, {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}]}
GLTF
cmake -S examples/whole-engine -B built -DCMAKE_PREFIX_PATH="$work/installed" >/dev/null
cmake --build built >/dev/null
built/whole_engine ground.gltf "frame_%02d.ppm"
for frame in 0 1 2; do [[ $(stat -c %s frame_0$frame.ppm) == 768015 ]]; done
cmp -s frame_00.ppm frame_02.ppm && { echo "the lamp did not move"; exit 1; }
if built/whole_engine nothing.gltf x.ppm 2>message; then echo "a missing file is no error"; exit 1; fi
grep -q "nothing.gltf" message

echo "== tone mapper: pkg-config"
"${CXX:-c++}" -std=c++17 -O2 examples/tone-mapper/main.cpp -o tone_mapper $(pkg-config --cflags --libs vesper)
./tone_mapper | tee tone.txt
[[ $(sed -n 's/^outside, 0.1 s: code //p' tone.txt) == $(sed -n 's/^outside once more.*code //p' tone.txt) ]]

echo "== python: ctypes"
for python in python3 /usr/bin/python3; do
    if "$python" -c "import numpy" 2>/dev/null; then
        "$python" examples/tonemap.py ramp.ppm
        [[ $(stat -c %s ramp.ppm) == 196623 ]]
        exit 0
    fi
done
echo "not run: python3-numpy is not installed"
