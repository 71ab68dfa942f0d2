/* Vesper for other programs and languages: photometric night rendering and tone mapping. SPDX-License-Identifier: MIT
 *
 * Everything a call needs is in its arguments and everything it makes is owned by the caller; there is no global state. An object
 * and what was made from it belong to one thread at a time; objects of different devices may be used at the same time. Objects are
 * destroyed in the reverse order: what was made from a device, then the device. Destroying nothing (a null pointer) is no error.
 *
 * Calls that can fail return a VesperResult and, where `error` is not null, fill in a line that names the file, place and reason.
 * Outputs are not touched then. Structures begin with their size: set it with VESPER_INIT, which zeroes the rest, or with the
 * vesper_*_defaults function where there is one. Fields are only ever added at the end.
 *
 * Units: metres, seconds, radians, lux, cd/m^2, candela. Colours are linear Rec. 709. Images have their first row at the top.
 */
#ifndef VESPER_VESPER_H
#define VESPER_VESPER_H

#include <stddef.h>
#include <stdint.h>

#if defined(VESPER_BUILDING_SHARED)
#define VESPER_API __attribute__((visibility("default")))
#else
#define VESPER_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/** The interface this header describes: programs built against a lower minor number go on working (semantic versioning). */
#define VESPER_VERSION_MAJOR 0
#define VESPER_VERSION_MINOR 1
/** Major, minor and patch number of the library that is linked. */
VESPER_API void vesper_version(uint32_t version[3]);

typedef enum VesperResult {
    VESPER_OK = 0,
    VESPER_BAD_ARGUMENT = 1, /**< a null pointer, a size or a number that cannot be */
    VESPER_FAILED = 2,       /**< a file, the device or a setting: see the message */
    VESPER_OUT_OF_MEMORY = 3 /**< on the host */
} VesperResult;

/** One line, ended by a zero; cut off where it does not fit. */
typedef struct VesperError {
    char message[1024];
} VesperError;

#define VESPER_INIT(type) {sizeof(type)}

/* Devices. */

typedef struct VesperDevice VesperDevice;

typedef struct VesperDeviceOptions {
    uint32_t size;
    const char *select; /**< part of a name, "cpu", or an index; null: the environment's VESPER_DEVICE, else the best there is */
    int32_t validation; /**< whether the Khronos layer checks all calls; it must be installed */
    void (*on_message)(const char *message, void *user); /**< for each message of the layer; may be null */
    void *user;
} VesperDeviceOptions;

/** Opens a Vulkan 1.3 device. `options` may be null. */
VESPER_API VesperResult vesper_device_open(const VesperDeviceOptions *options, VesperDevice **device, VesperError *error);
VESPER_API void vesper_device_close(VesperDevice *device);
/** Valid until the device is closed. */
VESPER_API const char *vesper_device_name(const VesperDevice *device);

/* How luminance is shown. */

/** The operators, by the names that vesper tonemap --help explains. */
typedef enum VesperOperator {
    VESPER_IRAWAN = 0,
    VESPER_WARD = 1,
    VESPER_REINHARD = 2,
    VESPER_LINEAR = 3,
    VESPER_PATTANAIK = 5,
    VESPER_FERWERDA = 6,
    VESPER_DURAND = 7,
    VESPER_GRAVE = 8
} VesperOperator;

/** Light scattered in the eye, before anything adapts to it. */
typedef enum VesperGlare {
    VESPER_GLARE_NONE = 0,
    VESPER_GLARE_CIE = 1, /**< CIE total glare function (CIE 135/1, 1999) of an eye of `age` and `pigmentation` */
    VESPER_GLARE_LDR = 2  /**< that of Petit, Bremond and Vienne, on the tone-mapped image */
} VesperGlare;

typedef struct VesperToneSettings {
    uint32_t size;
    uint32_t tone_operator;    /**< a VesperOperator */
    uint32_t glare;            /**< a VesperGlare */
    uint32_t bins;             /**< of the histogram, 1 to 256 */
    float age;                 /**< of the observer, years */
    float pigmentation;        /**< of the iris: 0 very dark, 0.5 brown, 1 green, 1.2 light blue */
    float gaze[2];             /**< where the eye looks, parts of the image from its top left */
    int32_t colour_loss, acuity_loss, purkinje; /**< what dim light loses (0 or 1) */
    const char *display;       /**< name or file of a profile (docs/display.md); null: the three numbers below */
    float display_peak;        /**< luminance of white in the dark, cd/m^2 */
    float display_black;       /**< luminance of black in the dark, cd/m^2 */
    float display_ambient;     /**< illuminance on the screen, lx */
} VesperToneSettings;

VESPER_API void vesper_tone_settings_defaults(VesperToneSettings *settings);

/** What a frame brings besides its pixels. */
typedef struct VesperFrameReport {
    uint32_t size;        /**< comes back as what this library knows */
    float adaptation;     /**< luminance the eye adapts to, cd/m^2 */
    float log_average;    /**< of the luminance of the frame, cd/m^2 */
    uint64_t not_finite;  /**< pixels that are NaN or infinite: shown black */
    double milliseconds;  /**< from the call to the device being done, on the host's clock */
} VesperFrameReport;

/** Where a frame goes; what is null is not made. Buffers are the caller's, width * height * 4 values each. */
typedef struct VesperOutputs {
    uint32_t size;
    uint8_t *codes;      /**< RGBA of the display, 8 bits; for a display of 10 bits words of A2B10G10R10 */
    float *luminance;    /**< RGBA, cd/m^2 of the scene, without glare */
    float *display_light; /**< RGBA, cd/m^2 the display would show without its limits */
    VesperFrameReport *report;
} VesperOutputs;

/* Pictures of other origin. */

typedef struct VesperToneMapper VesperToneMapper;

typedef struct VesperPicture {
    uint32_t size;
    uint32_t width, height;  /**< px */
    uint32_t channels;       /**< 3 (RGB) or 4 (the fourth is ignored) */
    const float *values;     /**< width * height * channels */
    float scale;             /**< cd/m^2 of a value of 1 */
    float vertical_fov;      /**< the angle the picture covers in height, rad */
} VesperPicture;

VESPER_API VesperResult vesper_tone_mapper_create(VesperDevice *device, VesperToneMapper **mapper, VesperError *error);
VESPER_API void vesper_tone_mapper_destroy(VesperToneMapper *mapper);
/** `seconds` have passed since the last picture: the eye adapts from each to the next, also when their size changes. */
VESPER_API VesperResult vesper_tone_map(VesperToneMapper *mapper, const VesperToneSettings *settings, const VesperPicture *picture, float seconds,
                                        const VesperOutputs *outputs, VesperError *error);
/** Forgets what the eye was adapted to, as at a cut. */
VESPER_API void vesper_tone_mapper_reset(VesperToneMapper *mapper);
/** Bytes of what the eye remembers. */
VESPER_API size_t vesper_eye_size(void);
/** What the eye remembers after the last picture: `bytes` of vesper_eye_size(), to be kept as they are, for the same version. */
VESPER_API VesperResult vesper_tone_mapper_eye(const VesperToneMapper *mapper, void *bytes, VesperError *error);
/** The next picture goes on from there. */
VESPER_API VesperResult vesper_tone_mapper_set_eye(VesperToneMapper *mapper, const void *bytes, size_t size, VesperError *error);

/* Scenes. */

typedef struct VesperScene VesperScene;

/** Reads a photometric scene (.gltf or .glb, as vesper convert writes them). */
VESPER_API VesperResult vesper_scene_read(const char *file, VesperScene **scene, VesperError *error);
VESPER_API void vesper_scene_destroy(VesperScene *scene);
VESPER_API uint32_t vesper_scene_node_count(const VesperScene *scene);
/** Valid as long as the scene; null where there is no such node. */
VESPER_API const char *vesper_scene_node_name(const VesperScene *scene, uint32_t node);

typedef struct VesperLamp {
    uint32_t size;
    float position[3];   /**< world, m */
    float axis[3];       /**< unit vector along which it shines; of a point lamp any */
    float intensity;     /**< on the axis, cd */
    float colour[3];     /**< linear Rec. 709; scaled to luminance 1 */
    float outer_cone;    /**< half angle beyond which it is dark, rad, up to pi / 2; 0: a point lamp */
    float inner_cone;    /**< half angle of full intensity, rad */
} VesperLamp;

/** Adds a lamp, before a renderer is made. `node` is the place it moves by (vesper_renderer_place). */
VESPER_API VesperResult vesper_scene_add_lamp(VesperScene *scene, const VesperLamp *lamp, uint32_t *node, VesperError *error);

typedef struct VesperRenderer VesperRenderer;

/** Takes what it needs of the scene to the device. The scene must outlive it and not change. */
VESPER_API VesperResult vesper_renderer_create(VesperDevice *device, const VesperScene *scene, VesperRenderer **renderer, VesperError *error);
VESPER_API void vesper_renderer_destroy(VesperRenderer *renderer);
/** Puts a node, and what hangs on it, somewhere else from now on: node frame to world, column by column, m. */
VESPER_API VesperResult vesper_renderer_place(VesperRenderer *renderer, uint32_t node, const float node_to_world[16], VesperError *error);

/** Where the eye is. */
typedef struct VesperView {
    uint32_t size;
    uint32_t width, height;   /**< px */
    const char *camera;       /**< a camera of the scene; null: the five below */
    float eye[3], forward[3], up[3]; /**< world, m; directions of any length */
    float vertical_fov;       /**< rad */
    float near_plane;         /**< nothing nearer is drawn, m */
    double scene_seconds;     /**< of the scene's animations */
} VesperView;

/** `seconds` have passed since the last frame, for the eye. */
VESPER_API VesperResult vesper_render(VesperRenderer *renderer, const VesperToneSettings *settings, const VesperView *view, float seconds,
                                      const VesperOutputs *outputs, VesperError *error);
/** Forgets what the eye was adapted to, as at a camera cut. */
VESPER_API void vesper_renderer_reset(VesperRenderer *renderer);

#ifdef __cplusplus
}
#endif
#endif
