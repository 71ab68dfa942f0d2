/* Whole engine: a scene from a file, a lamp of one's own that moves, frames as pictures. SPDX-License-Identifier: MIT
 *     whole_engine SCENE.gltf OUT_%02d.ppm
 */
#include <stdio.h>
#include <stdlib.h>

#include <vesper/vesper.h>

enum { kWidth = 640, kHeight = 400, kFrames = 3 };

static void stop_if(VesperResult result, const VesperError *error) {
    if (result == VESPER_OK) return;
    fprintf(stderr, "whole_engine: %s\n", error->message);
    exit(1);
}

static void write_picture(const char *pattern, int frame, const uint8_t *codes) {
    char name[1024];
    snprintf(name, sizeof name, pattern, frame);
    FILE *file = fopen(name, "wb");
    if (!file) {
        perror(name);
        exit(1);
    }
    fprintf(file, "P6\n%d %d\n255\n", kWidth, kHeight);
    for (size_t i = 0; i < (size_t)kWidth * kHeight; ++i) fwrite(codes + 4 * i, 1, 3, file);
    if (fclose(file)) exit(1);
}

int main(int count, char **arguments) {
    if (count != 3) {
        fprintf(stderr, "usage: whole_engine SCENE.gltf OUT_%%02d.ppm\n");
        return 2;
    }
    VesperError error;
    VesperDevice *device = NULL;
    VesperScene *scene = NULL;
    VesperRenderer *renderer = NULL;
    stop_if(vesper_device_open(NULL, &device, &error), &error);
    stop_if(vesper_scene_read(arguments[1], &scene, &error), &error);

    /* A spot of 2,000 cd, aimed down. */
    VesperLamp lamp = VESPER_INIT(VesperLamp);
    lamp.position[1] = 4;
    lamp.axis[1] = -1;
    lamp.intensity = 2000;
    lamp.colour[0] = lamp.colour[1] = lamp.colour[2] = 1;
    lamp.inner_cone = 0.4f, lamp.outer_cone = 0.7f;
    uint32_t node = 0;
    stop_if(vesper_scene_add_lamp(scene, &lamp, &node, &error), &error);
    stop_if(vesper_renderer_create(device, scene, &renderer, &error), &error);

    VesperToneSettings settings;
    vesper_tone_settings_defaults(&settings);
    settings.glare = VESPER_GLARE_CIE;
    VesperView view = VESPER_INIT(VesperView);
    view.width = kWidth, view.height = kHeight;
    view.eye[1] = 1.2f, view.eye[2] = 12;
    view.forward[2] = -1, view.up[1] = 1;
    view.vertical_fov = 0.7f, view.near_plane = 0.1f;
    uint8_t *codes = malloc((size_t)kWidth * kHeight * 4);
    if (!codes) return 1;
    VesperFrameReport report = VESPER_INIT(VesperFrameReport);
    VesperOutputs outputs = VESPER_INIT(VesperOutputs);
    outputs.codes = codes, outputs.report = &report;
    for (int frame = 0; frame < kFrames; ++frame) {
        /* Column by column: the lamp's frame, which shines along its -z, 4 m above the ground. */
        const float place[16] = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, (float)(2 * frame - 2), 4, 0, 1};
        stop_if(vesper_renderer_place(renderer, node, place, &error), &error);
        stop_if(vesper_render(renderer, &settings, &view, 1 / 30.0f, &outputs, &error), &error);
        write_picture(arguments[2], frame, codes);
        printf("frame %d: the eye is adapted to %.3g cd/m^2, %.0f ms\n", frame, report.adaptation, report.milliseconds);
    }
    free(codes);
    vesper_renderer_destroy(renderer);
    vesper_scene_destroy(scene);
    vesper_device_close(device);
    return 0;
}
