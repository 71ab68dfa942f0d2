/* Whole engine: a scene from a file, or of nothing (-); a car made in memory, with a headlamp, that drives; frames as
 * pictures. SPDX-License-Identifier: MIT whole_engine SCENE.gltf|- OUT_%02d.ppm
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <vesper/vesper.h>

enum { kWidth = 640, kHeight = 400, kFrames = 3 };

static void stop_if(VesperResult result, const VesperError* error) {
    if (result == VESPER_OK) return;
    fprintf(stderr, "whole_engine: %s\n", error->message);
    exit(1);
}

static void write_picture(const char* pattern, int frame, const uint8_t* codes) {
    char name[1024];
    snprintf(name, sizeof name, pattern, frame);
    FILE* file = fopen(name, "wb");
    if (!file) {
        perror(name);
        exit(1);
    }
    fprintf(file, "P6\n%d %d\n255\n", kWidth, kHeight);
    for (size_t i = 0; i < (size_t)kWidth * kHeight; ++i) fwrite(codes + 4 * i, 1, 3, file);
    if (fclose(file)) exit(1);
}

/* A box of 1 m about the middle of its bottom: 8 corners, 12 triangles seen from outside. */
static uint32_t add_box(VesperScene* scene, float red, float green, float blue) {
    static const float corners[] = {-.5f, 0, -.5f, .5f, 0, -.5f, .5f, 1, -.5f, -.5f, 1, -.5f,
                                    -.5f, 0, .5f,  .5f, 0, .5f,  .5f, 1, .5f,  -.5f, 1, .5f};
    static const uint32_t triangles[] = {0, 3, 2, 0, 2, 1, 4, 5, 6, 4, 6, 7, 0, 4, 7, 0, 7, 3,
                                         1, 2, 6, 1, 6, 5, 3, 7, 6, 3, 6, 2, 0, 1, 5, 0, 5, 4};
    VesperError error;
    uint32_t index = 0;
    VesperMaterial material = VESPER_INIT(VesperMaterial);
    material.base_colour[0] = red, material.base_colour[1] = green, material.base_colour[2] = blue;
    material.roughness = 0.6f;
    stop_if(vesper_scene_add_material(scene, &material, &index, &error), &error);
    VesperMesh box = VESPER_INIT(VesperMesh);
    box.material = index;
    box.vertex_count = 8, box.positions = corners;
    box.index_count = 36, box.indices = triangles;
    stop_if(vesper_scene_add_mesh(scene, &box, &index, &error), &error);
    return index;
}

int main(int count, char** arguments) {
    if (count != 3) {
        fprintf(stderr, "usage: whole_engine SCENE.gltf|- OUT_%%02d.ppm\n");
        return 2;
    }
    VesperError error;
    VesperDevice* device = NULL;
    VesperScene* scene = NULL;
    VesperRenderer* renderer = NULL;
    stop_if(vesper_device_open(NULL, &device, &error), &error);
    const int from_nothing = strcmp(arguments[1], "-") == 0;
    stop_if(from_nothing ? vesper_scene_create(&scene, &error) : vesper_scene_read(arguments[1], &scene, &error),
            &error);

    /* A car that heads to the right, its frame on the road below its middle: a body, a cabin, and a headlamp of 20,000
     * cd that looks down a little. */
    uint32_t car = 0, part = 0, ground = 0, lamp = 0;
    const float body[16] = {4, 0, 0, 0, 0, 0.7f, 0, 0, 0, 0, 1.7f, 0, 0, 0.2f, 0, 1},
                cabin[16] = {2, 0, 0, 0, 0, 0.6f, 0, 0, 0, 0, 1.5f, 0, -0.3f, 0.9f, 0, 1};
    const float road[16] = {60, 0, 0, 0, 0, 0.1f, 0, 0, 0, 0, 30, 0, 0, -0.11f, 0, 1};
    const uint32_t red = add_box(scene, 0.5f, 0.1f, 0.05f), grey = add_box(scene, 0.2f, 0.2f, 0.2f);
    stop_if(vesper_scene_add_node(scene, "road", grey, road, &ground, &error), &error);
    stop_if(vesper_scene_add_node(scene, "car", VESPER_NONE, NULL, &car, &error), &error);
    stop_if(vesper_scene_add_node(scene, "body", red, body, &part, &error), &error);
    stop_if(vesper_scene_attach(scene, part, car, &error), &error);
    stop_if(vesper_scene_add_node(scene, "cabin", red, cabin, &part, &error), &error);
    stop_if(vesper_scene_attach(scene, part, car, &error), &error);
    VesperLamp headlamp = VESPER_INIT(VesperLamp);
    headlamp.position[0] = 2.05f, headlamp.position[1] = 0.65f;
    headlamp.axis[0] = 1, headlamp.axis[1] = -0.08f;
    headlamp.intensity = 20000;
    headlamp.colour[0] = headlamp.colour[1] = 1, headlamp.colour[2] = 0.9f;
    headlamp.inner_cone = 0.1f, headlamp.outer_cone = 0.4f;
    stop_if(vesper_scene_add_lamp(scene, &headlamp, &lamp, &error), &error);
    stop_if(vesper_scene_attach(scene, lamp, car, &error), &error);
    const float ambient[3] = {5, 5, 6}, sky[3] = {0.02f, 0.02f, 0.03f};
    stop_if(vesper_scene_set_sky(scene, ambient, sky, &error), &error);
    stop_if(vesper_renderer_create(device, scene, &renderer, &error), &error);

    VesperToneSettings settings;
    vesper_tone_settings_defaults(&settings, sizeof settings);
    settings.glare = VESPER_GLARE_CIE;
    VesperView view = VESPER_INIT(VesperView);
    view.width = kWidth, view.height = kHeight;
    view.eye[1] = 1.2f, view.eye[2] = 12;
    view.forward[2] = -1, view.up[1] = 1;
    view.vertical_fov = 0.7f, view.near_plane = 0.1f;
    uint8_t* codes = malloc((size_t)kWidth * kHeight * 4);
    if (!codes) return 1;
    VesperFrameReport report = VESPER_INIT(VesperFrameReport);
    VesperOutputs outputs = VESPER_INIT(VesperOutputs);
    outputs.codes = codes, outputs.report = &report;
    for (int frame = 0; frame < kFrames; ++frame) {
        /* Column by column. */
        const float place[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, (float)(2 * frame - 5), 0, 0, 1};
        stop_if(vesper_renderer_place(renderer, car, place, &error), &error);
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
