#!/usr/bin/env bash
# Installs everything somewhere, moves that, and uses it as somebody would who never saw this source tree; nothing installed,
# and nothing that the programs write, names a folder of this machine. SPDX-License-Identifier: MIT
#     installed.sh BUILD_FOLDER SOURCE_FOLDER
set -euo pipefail
export VESPER_CACHE=off  # not that of whoever runs this
build=$(realpath "$1") source=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
cmake --install "$build" --prefix "$work/first" >/dev/null
mv first moved
mkdir out && cd out
bin=../moved/bin data=../moved/share/vesper documents=../moved/share/doc/vesper

# no_paths FOLDER: what is for debuggers may name sources, and is looked past.
no_paths() {
    local file bare=$work/stripped found=0
    while IFS= read -r -d '' file; do
        cp "$file" "$bare"
        case $(head -c 7 "$file" | tr -d '\0') in $'\x7fELF'* | '!<arch>') strip --strip-debug "$bare" ;; esac
        for folder in "$build" "$source" "$work/first"; do
            grep -aqF "$folder" "$bare" || continue
            echo "$file names $folder: $(strings -a "$bare" | grep -m 1 -F "$folder")"
            found=1
        done
    done < <(find "$1" -type f -print0)
    return $found
}

echo "== everything is there"
for file in $bin/vesper{,-drive,-bench} ../moved/share/man/man1/vesper{,-drive,-bench}.1 \
    $data/{photometry.schema.json,rivoli/rivoli.world.json,examples/kaykit-street/assemble.py} \
    $documents/{copyright,README.md,docs/simulator.md,examples/tonemap.py}; do
    [[ -s $file ]] || { echo "$file is missing"; exit 1; }
done
[[ ! -e $data/rivoli/generate.py && ! -e $data/rivoli/street ]]
grep -q '^\.SH "vesper display fit"' ../moved/share/man/man1/vesper.1

echo "== no path of this machine is installed"
no_paths ../moved

echo "== the programs find their data"
$bin/vesper convert $data/photometry/yard.gltf --photometry $data/photometry/yard.photometry.json -o yard.gltf >/dev/null
$bin/vesper render yard.gltf --size 64x40 -o yard.png -o yard.exr
$bin/vesper-drive --headless --indirect off --autopilot --size 96x60 --seconds 0.1 --fps 30 --record drive.json --log drive.csv --video a%d.exr
head=$(head -c 200 drive.json)
[[ $head == *'"scene":"vesper:rivoli/rivoli.world.json"'* ]] || { echo "the recording names its scene otherwise: $head"; exit 1; }
$bin/vesper-bench --scene rivoli --size 64x40 --frames 2 --laps 1 --warm-up 0 --no-start --json bench.json >/dev/null

echo "== a recording goes along to another prefix"
mv ../moved ../elsewhere
../elsewhere/bin/vesper-drive --headless --replay drive.json --video b%d.exr
for frame in 0 1 2 3; do cmp a$frame.exr b$frame.exr; done  # headers, too

echo "== no path of this machine is written"
no_paths .

echo "== without data, one line says where it was looked for"
mkdir -p ../bare/bin && cp ../elsewhere/bin/vesper-drive ../bare/bin
if ../bare/bin/vesper-drive --headless --seconds 0 --log none.csv 2>message; then exit 1; fi
[[ $(wc -l <message) == 1 ]]
grep -qF "$work/bare/share/vesper" message
