# Files that fuzzers begin with; sourced in the source folder. SPDX-License-Identifier: MIT

# seeds READER: files of its kind, at most 64 KiB each.
seeds() {
    local name
    case $1 in
        gltf) name='*.gltf' ;;
        glb) name='*.glb' ;;
        photometry) name='*.photometry.json' ;;
        ies) name='*.ies' ;;
        ldt) name='*.ldt' ;;
        grid_csv | reflection_table | display_measurements | response | esmini_run | tone_log | lamp_list) name='*.csv' ;;
        osi_trace) name='*.osi' ;;
        osi_datagrams) name='*.datagrams' ;;
        image | exif) name='*.[jp][pn]g' ;;
        wide_png) name='*.png' ;;
        warp_mesh) name='*.data' ;;
        exr | grid_exr) name='*.exr' ;;
        radiance) name='*.hdr' ;;
        compressed) name='*.geometry' ;;
        opendrive) name='*.xodr' ;;
        world) name='*.world.json' ;;
        *) name='*.json' ;;
    esac
    find data tests/fuzz/found/"$1" ../shared/data -type f -name "$name" -size -64k 2>/dev/null || true
    find tests/fuzz/found/"$1" -type f 2>/dev/null || true
}

# plant READER FOLDER: copies of them, named by what is in them.
plant() {
    mkdir -p "$2"
    local file
    while read -r file; do cp "$file" "$2/seed-$(sha1sum "$file" | cut -c1-16)"; done < <(seeds "$1")
}
