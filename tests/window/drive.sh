#!/usr/bin/env bash
# Opens vesper-drive on a display of its own and drives it by keys, as somebody would: steers, resizes, minimises and fills the
# screen, switches operators, breaks the scene's file, records. What the window shows is the headless picture of the same frame, and a replay of the recording, twice, gives
# the same bytes. Panels fit a small window, and Escape closes them before it ends the program. The validation layer watches. Waits
# for what the title says, never for a time. SPDX-License-Identifier: MIT
#   tests/window/drive.sh VESPER_DRIVE WORLD LOSE_DEVICE (the built lose_device.cpp)
set -euo pipefail
export VESPER_CACHE=off  # not that of whoever runs this

program=$1 world=$2 lose=$3
for tool in Xvfb xdotool import compare convert openbox; do
    command -v "$tool" >/dev/null || { echo "skipped: $tool is missing (Debian, Ubuntu: apt install xvfb xdotool openbox imagemagick)"; exit 77; }
done

folder=$(mktemp -d)
# A street of our own, to be broken.
cp -r "${world%/*}" "$folder/street"
ln -s "${world%/*/*}/photometry" "$folder"
cd "$folder"
world=street/${world##*/}
started=()
finish() {
    for pid in "${started[@]}"; do kill "$pid" 2>/dev/null || true; done
    wait 2>/dev/null || true
    rm -rf "$folder"
}
trap finish EXIT
fail() {
    echo "failed: $*" >&2
    echo "title: $(title)" >&2
    cat said.txt >&2 2>/dev/null || true
    exit 1
}

# The X server says which display it took.
mkfifo display
Xvfb -displayfd 3 -screen 0 900x640x24 -nolisten tcp -noreset 3>display >/dev/null 2>&1 &
started+=($!)
read -r number <display
export DISPLAY=:$number
unset WAYLAND_DISPLAY
openbox >/dev/null 2>&1 &
started+=($!)
# GLFW waits without end for a window that is opened before its manager is there.
for ((i = 0; i < 600; ++i)); do xdotool get_num_desktops >/dev/null 2>&1 && break; sleep 0.1; done

window=
title() { xdotool getwindowname "$window" 2>/dev/null || true; }
# until WHAT COMMAND...: tries until the command succeeds; gives up after very long.
until_true() {
    local what=$1
    shift
    for ((i = 0; i < 600; ++i)); do
        "$@" >/dev/null 2>&1 && return
        kill -0 "$drive" 2>/dev/null || fail "vesper-drive ended while waiting for $what"
        sleep 0.2
    done
    fail "waited in vain for $what"
}
titled() { [[ $(title) == *"$1"* ]]; }
untitled() { [[ $(title) != *"$1"* ]]; }
key() { xdotool key --window "$window" "$1"; }
# quit WHAT [KEY]: the window may be gone before the keys are up again, which ends xdotool with an X error; and once in a hundred
# times they go astray.
quit() {
    local presses=0
    while kill -0 "$drive" 2>/dev/null; do
        ((++presses <= 20)) || fail "$1 does not end"
        xdotool key --window "$window" "${2:-ctrl+q}" 2>/dev/null || true
        for ((i = 0; i < 50; ++i)); do kill -0 "$drive" 2>/dev/null || break; sleep 0.1; done
    done
    wait "$drive" || fail "$1 ended with $?"
}
find_window() { window=$(xdotool search --name ' - Vesper$' | head -n 1) && [[ -n $window ]]; }
seconds() { title | sed -E 's/.*, ([0-9.]+) s, .*/\1/'; }
beyond() { awk -v now="$(seconds)" -v than="$1" 'BEGIN { exit !(now > than) }'; }
sized() { [[ $(xdotool getwindowgeometry "$window") == *"Geometry: $1"* ]]; }
# Identical pixels, whatever else the files say.
same() { [[ $(compare -metric AE "$1" "$2" null: 2>&1) == 0 ]]; }

VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT \
    "$program" "$world" --allow-outside . --shadows off --indirect off --size 240x150 --window 240x150 --device cpu --record drive.json >said.txt 2>&1 &
drive=$!
started+=("$drive")
until_true "a window" find_window
until_true "time to pass" beyond 0.2
titled "irawan, driver, recording" || fail "is not irawan, seen by the driver, recorded"

# Drives, by keys that are held.
xdotool windowfocus --sync "$window"
xdotool keydown --window "$window" Up
until_true "some driving" beyond 1.5
xdotool keydown --window "$window" Left
xdotool windowsize "$window" 333 222
until_true "another size" sized 333x222
until_true "more driving" beyond 2.5
xdotool keyup --window "$window" Left
key o
until_true "the next operator" titled ward
key g
key c
until_true "another camera" titled chase
xdotool keyup --window "$window" Up
xdotool windowsize "$window" 240 150
until_true "the first size" sized 240x150
key 1
until_true "the driver's camera" titled driver

# Full screen and back, minimised and back, every way of waiting for the screen.
key F11
until_true "full screen" sized 900x640
key m
key m
key F11
until_true "a window again" sized 240x150
key m
xdotool windowminimize --sync "$window"
xdotool windowactivate "$window"
now=$(seconds)
until_true "time after the window is back" beyond "$(awk -v t="$now" 'BEGIN { print t + 0.2 }')"

# A scene that cannot be read any more is named; the drive, and its recording, go on.
mv "$world" kept.json
echo '{' >"$world"
key ctrl+r
until_true "a complaint about the scene" grep -q "^vesper-drive: .*$world" said.txt
mv kept.json "$world"
# So is one that reads what the recording will replace.
photometry=street/rivoli-drive.photometry.json
mv "$photometry" kept.json
cp kept.json drive.json
ln -s ../drive.json "$photometry"
key ctrl+r
until_true "a complaint about the recording" grep -q "drive.json: would replace what is read" said.txt
rm drive.json "$photometry"
mv kept.json "$photometry"
titled recording || fail "the recording has ended with the scene"
key F4
key space
until_true "a pause" titled paused

# The picture that stands there, without instruments.
key F2
key F12
until_true "a saved picture" test -s picture-001.png
plain() { import -silent -window "$window" shown.png && same shown.png picture-001.png; }
until_true "the plain picture in the window" plain

quit vesper-drive
grep -qE 'VUID|SYNC-|Validation' said.txt && fail "the validation layer complains"

# Where there is nothing to show a window or its codes on, a line says so.
refused() {
    local code=0
    "$@" >refused.txt 2>&1 || code=$?
    [[ $code == 2 && $(wc -l <refused.txt) == 1 && $(<refused.txt) == "vesper-drive: "* ]] || fail "$* ends with $code and says $(<refused.txt)"
}
refused env DISPLAY=:none "$program" "$world"
refused "$program" "$world" --fullscreen 7
refused "$program" "$world" --device cpu --size 64x64 --display hdr10

# A replay in a window: options given beside it win over what was recorded, and Backspace brings back all of the start.
"$program" --replay drive.json --shadows off --indirect off --operator grave --size 64x40 --window 240x150 --device cpu >said.txt 2>&1 &
drive=$!
started+=("$drive")
until_true "a window" find_window
until_true "the end of the replay" titled paused
titled "grave, " || fail "a recorded operator has replaced the one that was asked for"
key o
until_true "another operator" untitled grave
key BackSpace
until_true "the replay from its start" untitled paused
titled "grave, " || fail "starting again has not brought back the operator"
quit "the replay"

# In a window of 840 x 525 every panel is whole: none touches an edge of it. Escape gives the keyboard back to the drive, then closes
# the panels, then ends the program.
# A limit below which nothing is offered: no line says what would be faster in between, whatever else the machine does.
"$program" "$world" --shadows off --indirect off --quality fast --limit 15 --size 84x53 --window 840x525 --device cpu >said.txt 2>&1 &
drive=$!
started+=("$drive")
until_true "a window" find_window
until_true "its size" sized 840x525
until_true "time to pass" beyond 0.1
key space
until_true "a pause" titled paused
import -silent -window "$window" plain.png
# over HIDDEN: whether something lies over the plain picture beside that rectangle.
over() {
    import -silent -window "$window" now.png
    [[ $(convert now.png plain.png -compose difference -composite -threshold 0 -fill black -draw "rectangle $1" -format '%[fx:maxima>0]' info:) == 1 ]]
}
opened() { over 0,449,839,524; }  # panels are above the line of state
closed() { ! opened; }
touching() { over 4,4,835,520; }
for panel in F1 F3 F4 F5 F6 F7 F8 j; do
    key $panel
    until_true "the panel of $panel" opened
    touching && fail "the panel of $panel is cut off"
    key $panel
    until_true "the panel of $panel to close" closed
done
key F5
key Tab
until_true "panels" opened
key Escape
key o
until_true "the keyboard back at the drive" titled ward
opened || fail "Escape has closed the panels with the keyboard in them"
key shift+o
until_true "the first operator" titled irawan
key Escape
until_true "the panels to close" closed
kill -0 "$drive" || fail "Escape has ended the program before its panels"
quit "vesper-drive by Escape" Escape

# A device that is lost while driving is opened anew; the drive, and its recording, go on.
LD_PRELOAD=$lose LOSE_DEVICE_AT=60 "$program" "$world" --shadows off --indirect off --size 64x40 --window 240x150 --device cpu --record lost.json --log lost.csv >said.txt 2>&1 &
drive=$!
started+=("$drive")
until_true "a window" find_window
until_true "a lost device" grep -q "^vesper-drive: .*the device was lost; it was opened anew" said.txt
now=$(seconds)
until_true "time after the device is back" beyond "$(awk -v t="$now" 'BEGIN { print t + 0.3 }')"
titled recording || fail "the recording has ended with the device"
[[ -s lost.json.part && -s lost.csv.part && ! -e lost.json ]] || fail "what is recorded is not beside its place"
quit vesper-drive
[[ -s lost.json && -s lost.csv && ! -e lost.json.part && ! -e lost.csv.part ]] || fail "what was recorded has not taken its place"
"$program" --headless --replay lost.json --device cpu --size 64x40 --log again.csv >>said.txt 2>&1 || fail "the replay ended with $?"
grep -q 'another way' said.txt && fail "the replay of the lost device drives another way"

# A disk that takes no more ends the recording, with a message, and not the drive; what was recorded until then can be replayed.
(
    trap '' XFSZ
    exec "$program" "$world" --shadows off --indirect off --size 64x40 --window 240x150 --device cpu --record full.json >said.txt 2>&1
) &
drive=$!
started+=("$drive")
until_true "a window" find_window
titled recording || fail "is not recorded"
prlimit --pid "$drive" --fsize=16384
until_true "a full disk" grep -q "^vesper-drive: the recording ends: full.json: " said.txt
until_true "the end of the recording" untitled recording
now=$(seconds)
until_true "time after that" beyond "$(awk -v t="$now" 'BEGIN { print t + 0.3 }')"
quit vesper-drive
[[ -s full.json.part && ! -e full.json ]] || fail "what was recorded is not beside its place"
"$program" --headless --replay full.json.part --device cpu --size 64x40 --log full.csv >said.txt 2>&1 || fail "the replay ended with $?"
grep -q 'breaks off' said.txt || fail "the replay says nothing of its end"

# What was recorded, twice again, with the quality of the window: the same bytes, and the last frame is what it showed.
for run in a b; do
    mkdir $run
    "$program" --headless --replay drive.json --quality interactive --device cpu --size 240x150 --video "$run/%05d.png" >>said.txt 2>&1 || fail "the replay ended with $?"
done
frames=$(ls a | grep -c png)
((frames > 10)) || fail "only $frames frames"
for file in a/*.png; do cmp "$file" "b/${file##*/}" || fail "two replays differ"; done
grep -q 'another way' said.txt && fail "the replay drives another way"
same shown.png "$(ls a/*.png | tail -n 1)" || fail "the window shows other pixels than the headless program"
echo "drove $frames frames; the window, and two replays, show the same pixels"
