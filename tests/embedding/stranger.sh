#!/usr/bin/env bash
# Installs the built library somewhere, and builds and runs the examples as someone else's projects, with what the documentation says
# and nothing of this source tree. SPDX-License-Identifier: MIT
#     stranger.sh BUILD_FOLDER SOURCE_FOLDER
set -euo pipefail  # so no `| grep -q`: it ends at the first match, and what still writes then fails the line
export VESPER_CACHE=off  # not that of whoever runs this
build=$1 source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/installed" >/dev/null
cp -r "$source/apps/examples" "$work/examples"
cd "$work"
library=$(dirname "$(find installed -name 'libvesper-c.so')")
export CMAKE_GENERATOR=Ninja  # as this project; there may be no make
export LD_LIBRARY_PATH=$work/$library PKG_CONFIG_PATH=$work/$library/pkgconfig

echo "== headers: each alone, and without Vulkan where that is promised"
for header in installed/include/vesper/*; do
    printf '#include <vesper/%s>\nextern int not_empty;\n' "$(basename "$header")" >alone.cpp
    "${CXX:-c++}" -std=c++17 -Wall -Wextra -Wpedantic -Werror -Iinstalled/include -fsyntax-only alone.cpp
    [[ $header == *.hpp ]] || "${CC:-cc}" -std=c99 -Wall -Wextra -Wpedantic -Werror -Iinstalled/include -fsyntax-only -x c alone.cpp
    [[ $header == */vulkan.h ]] || [[ $("${CXX:-c++}" -std=c++17 -Iinstalled/include -M alone.cpp) != *vulkan_core* ]] || { echo "$header brings Vulkan"; exit 1; }
done
# With every warning, in whatever compilers there are.
warnings="-Wall -Wextra -Wpedantic -Wshadow -Werror -Iinstalled/include -fsyntax-only"
printf '#include <vesper/vesper.h>\nstatic VesperView view = VESPER_INIT(VesperView);\nint main(void) {\n    const VesperPicture picture = VESPER_INIT(VesperPicture);\n    return view.size != sizeof view || picture.size != sizeof picture;\n}\n' >init.c
for compilers in "${CC:-cc} ${CXX:-c++}" "gcc g++" "clang clang++"; do
    read -r c cxx <<<"$compilers"
    command -v "$c" "$cxx" >/dev/null || continue
    $c -std=c99 $warnings init.c
    $cxx -std=c++17 $warnings -x c++ init.c
    $c -std=c99 $warnings examples/whole-engine/main.c
    $cxx -std=c++17 $warnings examples/tone-mapper/main.cpp examples/roads/main.cpp
    $cxx -std=c++17 $warnings -Wno-missing-field-initializers examples/own-device/*.cpp  # which Vulkan's structures live from
done
nm -D --defined-only "$library/libvesper-c.so" | grep -v " vesper_" && { echo "the library shows more than its interface"; exit 1; }

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
cmp -s frame_00.ppm frame_02.ppm && { echo "the car did not move"; exit 1; }
built/whole_engine - "nothing_%02d.ppm"  # without a file
if built/whole_engine nothing.gltf x.ppm 2>message; then echo "a missing file is no error"; exit 1; fi
grep -q "nothing.gltf" message

echo "== own device: find_package"
cmake -S examples/own-device -B built-own -DCMAKE_PREFIX_PATH="$work/installed" >/dev/null
cmake --build built-own >/dev/null
built-own/own_device --help >help.txt
[[ $(grep -c "own_device OUT.ppm" help.txt) == 1 && ! -e ./--help ]]
for wrong in "" "--size" "a.ppm b.ppm"; do
    status=0
    built-own/own_device $wrong 2>message || status=$?
    [[ $status == 2 && $(wc -l <message) == 1 ]]
done
built-own/own_device own.ppm | tee own.txt
[[ $(stat -c %s own.ppm) == 768015 ]]
if grep "complaints" own.txt; then exit 1; fi

echo "== tone mapper: pkg-config"
"${CXX:-c++}" -std=c++17 -O2 examples/tone-mapper/main.cpp -o tone_mapper $(pkg-config --cflags --libs vesper)
./tone_mapper | tee tone.txt
[[ $(sed -n 's/^outside, 0.1 s: code //p' tone.txt) == $(sed -n 's/^outside once more.*code //p' tone.txt) ]]

"${CXX:-c++}" -std=c++17 -O2 examples/tone-mapper/main.cpp -o tone_mapper_static $(pkg-config --cflags --libs vesper-static)
./tone_mapper_static | diff - tone.txt
ldd tone_mapper_static | grep libvesper && { echo "that is not static"; exit 1; }

echo "== tone mapper: the static library, and the folder itself"
mkdir stranger stranger/cmake
for module in Functions Docs; do echo 'message(FATAL_ERROR "a module of the stranger")' >stranger/cmake/$module.cmake; done
cat >stranger/CMakeLists.txt <<'CMAKE'
cmake_minimum_required(VERSION 3.24)
project(stranger LANGUAGES C CXX)
set(CMAKE_CXX_STANDARD 17)
if(VESPER_FOLDER)
    list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_SOURCE_DIR}/cmake)
    set(CMAKE_CXX_VISIBILITY_PRESET hidden)
    add_subdirectory(${VESPER_FOLDER} vesper EXCLUDE_FROM_ALL)
    get_property(here DIRECTORY PROPERTY BUILDSYSTEM_TARGETS)
    if(TARGET docs OR NOT TARGET vesper::vesper-c OR here)
        message(FATAL_ERROR "the folder brings what nobody asked for: ${here}")
    endif()
else()
    find_package(vesper 0.1 CONFIG REQUIRED COMPONENTS static)
endif()
get_target_property(features vesper::vesper INTERFACE_COMPILE_FEATURES)
if(features)
    message(FATAL_ERROR "the library changes the stranger's language: ${features}")
endif()
add_executable(stranger ../examples/tone-mapper/main.cpp)
target_link_libraries(stranger PRIVATE vesper::vesper)
add_executable(sees sees.cpp)
target_link_libraries(sees PRIVATE vesper::analysis)
CMAKE
cat >stranger/sees.cpp <<'CPP'
#include <cstdio>
#include <vesper/vision.h>
int main() {
    const float luminance = 1.5f, background = 1;
    float level = 0;
    if (vesper_visibility_levels(nullptr, 1, &luminance, &background, &level, nullptr) != VESPER_OK) return 1;
    std::printf("%.3f\n", level);
}
CPP
mkdir asks
printf 'cmake_minimum_required(VERSION 3.24)\nproject(asks LANGUAGES CXX)\nfind_package(vesper CONFIG REQUIRED COMPONENTS shared opengl)\n' >asks/CMakeLists.txt
if cmake -S asks -B built-asks -DCMAKE_PREFIX_PATH="$work/installed" >/dev/null 2>message; then echo "a component that is not there is found"; exit 1; fi
grep -q "no component 'opengl'" message
cmake -S stranger -B built-static -DCMAKE_PREFIX_PATH="$work/installed" -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build built-static >/dev/null
built-static/stranger | diff - tone.txt
ldd built-static/stranger | grep libvesper && { echo "that is not static"; exit 1; }
# Adrian 1989 at 1 cd/m2, for 10', 0.2 s, 23 years: a threshold of 0.0807713 cd/m2.
[[ $(built-static/sees) == 6.190 ]]
"${CXX:-c++}" -std=c++17 -O2 stranger/sees.cpp -o sees_static $(pkg-config --cflags --libs vesper-static)
[[ $(./sees_static) == 6.190 ]]
cmake -S stranger -B built-folder -DVESPER_FOLDER="$source" -DCMAKE_BUILD_TYPE=Release >/dev/null
interface=vesper/engine/CMakeFiles/vesper-c.dir/api/device.cpp.o  # of a host that hides what it builds
cmake --build built-folder --target $interface >/dev/null
readelf --wide --symbols built-folder/$interface | grep "DEFAULT .* vesper_device_open$" >/dev/null || { echo "a host's visibility hides the interface"; exit 1; }
if [[ -n ${VESPER_BUILD_FOLDER:-} ]]; then  # all of the engine once more: minutes
    cmake --build built-folder -j "$(nproc)" >/dev/null
    built-folder/stranger | diff - tone.txt
fi

echo "== roads: find_package and pkg-config"
cat >straight.xodr <<'XODR'
<OpenDRIVE><header revMajor="1" revMinor="7"/><road id="1" length="90" junction="-1"><planView><geometry s="0" x="0" y="0" hdg="0" length="90"><line/></geometry></planView>
<lanes><laneSection s="0"><left><lane id="1" type="driving"><width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane></left><center><lane id="0" type="none"/></center>
<right><lane id="-1" type="driving"><width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane></right></laneSection></lanes></road></OpenDRIVE>
XODR
luminaire=installed/share/vesper/road/luminaire.ldt
cmake -S examples/roads -B built-roads -DCMAKE_PREFIX_PATH="$work/installed" >/dev/null
cmake --build built-roads >/dev/null
built-roads/roads $luminaire straight.xodr night.gltf | tee roads.txt
# The independent calculation of docs/road.md; a row of 30 m on 90 m of road.
[[ $(grep "^every 30 m" roads.txt) == "every 30 m: Lav 1.164 cd/m2, Uo 0.445, Ul 0.544, TI 14.96 %, EIR 0.698: M5" ]]
[[ $(grep "^street lamps" roads.txt) == "street lamps: 3, every 30 m" ]]
built/whole_engine night.gltf "night_%02d.ppm"
if built-roads/roads $luminaire none.xodr x.gltf 2>message >/dev/null; then echo "missing roads are no error"; exit 1; fi
grep -q "^roads: none.xodr: " message
"${CXX:-c++}" -std=c++17 -O2 examples/roads/main.cpp -o roads_pkgconfig $(pkg-config --cflags --libs vesper-roads)
./roads_pkgconfig $luminaire straight.xodr again.gltf | diff - roads.txt
cmp night.gltf again.gltf
[[ -z $(find installed -name '*vesper-traffic*') ]] || { echo "a library without a header is installed"; exit 1; }

echo "== python: ctypes"
for python in python3 /usr/bin/python3; do
    if "$python" -c "import numpy" 2>/dev/null; then
        "$python" examples/tonemap.py ramp.ppm
        [[ $(stat -c %s ramp.ppm) == 196623 ]]
        PYTHONPATH=examples "$python" - <<'PYTHON'
import numpy as np
from tonemap import ToneMapper
dark, bright = np.full((8, 8, 3), 0.1), np.full((8, 8, 3), 1e4)
with ToneMapper() as mapper:
    alone = mapper.map(bright)
    mapper.map(dark)
    assert (mapper.map(bright) == alone).all(), "a picture for itself depends on the one before"
    mapper.map(dark)
    assert (mapper.map(bright, seconds=0.05) != alone).any(), "the eye forgets what it saw"
    try:
        mapper.map(dark, glares=1)
        raise SystemExit("a setting that is none is taken")
    except TypeError:
        pass
mapper.close()
try:
    mapper.map(dark)
    raise SystemExit("maps with what is closed")
except RuntimeError as error:
    assert "no tone mapper" in str(error), error
PYTHON
        "$python" examples/night_figures.py night.svg
        "$python" - <<'PYTHON'
import csv
import xml.etree.ElementTree as xml
with open("night.csv", newline="") as file:
    rows = list(csv.DictReader(file))
assert len(rows) == 21 and len(rows[0]) == 8, rows[0]
# Adrian 1989 at 1 cd/m2, for 10', 0.2 s, 23 years: a threshold of 0.0807713 cd/m2.
assert abs(float(rows[10]["background_cd_m2"]) - 1) < 1e-5 and abs(float(rows[10]["scene"]) * 0.0807713 - 0.5) < 1e-4, rows[10]
assert len(xml.parse("night.svg").getroot().findall(".//{*}polyline")) == 7
PYTHON
        PYTHONPATH=examples "$python" - <<'PYTHON'
import numpy as np
from night_figures import Observer, Vision
plain = np.ones((64, 48, 3))
spot = plain.copy()
spot[20:26, 30:36] = 3
with Vision() as vision:
    probability, found = vision.compare(plain, spot, 0.03)
    assert probability.shape == (64, 48) and found.largest == probability.max() > 0.9 and abs(found.x - 33) < 5 > abs(found.y - 23)
    aged, _ = vision.compare(plain, plain * 1.001, 0.03, Observer(age=80, pigmentation=1))
    assert aged.max() < 0.1
    assert vision.fidelity(spot, spot, 0.03)["lost"].max() == 0
    assert vision.saliency(spot).shape == (4, 3)
    assert np.allclose(vision.visibility_level(1 + 2 * 0.0807713, np.ones((2, 1))), [[2], [2]], atol=1e-4)
    try:
        vision.visibility_level(np.nan, 1)
        raise SystemExit("the level of no luminance")
    except RuntimeError as error:
        assert "luminances are" in str(error), error
PYTHON
        exit 0
    fi
done
echo "not run: python3-numpy is not installed"
