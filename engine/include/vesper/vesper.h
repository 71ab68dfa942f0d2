/** @file
 * Vesper for other programs and languages: photometric night rendering and tone mapping.
 *
 * Everything a call needs is in its arguments and everything it makes is owned by the caller; there is no global state. An object
 * and what was made from it belong to one thread at a time; objects of different devices may be used at the same time. Objects are
 * destroyed in the reverse order: what was made from a device, then the device. Destroying nothing (a null pointer) is no error.
 *
 * Calls that can fail return a VesperResult and, where `error` is not null, fill in a line that names the file, place and reason.
 * Outputs are not touched then. Where settings may be given, null stands for the defaults. Structures begin with their size: set it with VESPER_INIT, which zeroes the rest, or with the
 * `vesper_*_defaults` function where there is one. Fields are only ever added at the end.
 *
 * Units: metres, seconds, radians, lux, cd/m^2, candela. Colours are linear Rec. 709. Images have their first row at the top.
 * Matrices are column by column, y is up, lamps and cameras look along their -z.
 *
 * SPDX-License-Identifier: MIT
 */
#ifndef VESPER_VESPER_H
#define VESPER_VESPER_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C++" {
/** Behind VESPER_INIT. */
template <class T>
constexpr T vesper_init() {
    T made{};
    made.size = sizeof made;
    return made;
}
}
extern "C" {
#endif

/** @name Version
 * Of the interface that this header describes (semantic versioning, docs/embedding.md).
 * @{ */
#define VESPER_VERSION_MAJOR 0 /**< changes when something is taken away */
#define VESPER_VERSION_MINOR 1 /**< changes when something is added, and before 1.0 also when something is taken away */
#define VESPER_VERSION_PATCH 0 /**< changes when something works better */
/** @} */

/** Major, minor and patch number of the library that is linked; null is passed over. */
void vesper_version(uint32_t version[3]);

/** What came of a call. */
typedef enum VesperResult {
    VESPER_OK = 0,                   /**< it did what it says */
    VESPER_BAD_ARGUMENT = 1,         /**< a null pointer, a size or a number that cannot be */
    VESPER_FAILED = 2,               /**< a file, a display or the device: see the message */
    VESPER_OUT_OF_MEMORY = 3,        /**< of the host */
    VESPER_OUT_OF_DEVICE_MEMORY = 4, /**< smaller pictures may still fit; nothing is broken */
    VESPER_DEVICE_LOST = 5           /**< what was made from the device can only be destroyed; a new device may work */
} VesperResult;

/** One line, ended by a zero; cut off where it does not fit. */
typedef struct VesperError {
    char message[1024]; /**< in English */
} VesperError;

/** A structure with its size set and everything else zero, where one is made: VesperView view = VESPER_INIT(VesperView). */
#ifdef __cplusplus
#define VESPER_INIT(type) vesper_init<type>()
#else
#define VESPER_INIT(type) {.size = sizeof(type)}
#endif

/** In place of an index where there is nothing. */
#define VESPER_NONE 0xffffffffu

/** @name Devices
 * @{ */

/** A Vulkan device, opened by Vesper or borrowed from its host (vesper/vulkan.h). */
typedef struct VesperDevice VesperDevice;

/** Which device, and who hears of mistakes. */
typedef struct VesperDeviceOptions {
    uint32_t size; /**< of this structure */
    const char *select; /**< part of a name, "cpu", or an index; null: the environment's VESPER_DEVICE, else the best there is */
    int32_t validation; /**< whether the Khronos layer checks all calls; it must be installed */
    void (*on_message)(const char *message, void *user); /**< for each message of the layer; may be null */
    void *user; /**< handed to on_message */
} VesperDeviceOptions;

/** Opens a Vulkan 1.3 device. `options` may be null. */
VesperResult vesper_device_open(const VesperDeviceOptions *options, VesperDevice **device, VesperError *error);
/** Closes a device, of which nothing is left; one that was borrowed is only given back. */
void vesper_device_close(VesperDevice *device);
/** Valid until the device is closed. */
const char *vesper_device_name(const VesperDevice *device);

/** @} */

/** @name How luminance is shown
 * @{ */

/** The operators, by the names that vesper tonemap --help explains. */
typedef enum VesperOperator {
    VESPER_IRAWAN = 0,    /**< Irawan, Ferwerda and Marschner 2005, reconstructed: an eye that adapts over time */
    VESPER_WARD = 1,      /**< Ward Larson, Rushmeier and Piatko 1997 */
    VESPER_REINHARD = 2,  /**< Reinhard, Stark, Shirley and Ferwerda 2002, global */
    VESPER_LINEAR = 3,    /**< linear between two luminances */
    VESPER_PATTANAIK = 5, /**< Pattanaik, Tumblin, Yee and Greenberg 2000: an eye that adapts over time */
    VESPER_FERWERDA = 6,  /**< Ferwerda, Pattanaik, Shirley and Greenberg 1996 */
    VESPER_DURAND = 7,    /**< Durand and Dorsey 2000, reconstructed: an eye that adapts over time, also to colour */
    VESPER_GRAVE = 8      /**< Grave and Bremond 2008, reconstructed: bands of contrast */
} VesperOperator;

/** Light scattered in the eye, before anything adapts to it (docs/glare.md). */
typedef enum VesperGlare {
    VESPER_GLARE_NONE = 0,     /**< none */
    VESPER_GLARE_CIE = 1,      /**< CIE total glare function (CIE 135/1, 1999) of an eye of `age` and `pigmentation` */
    VESPER_GLARE_LDR = 2,      /**< that of Petit, Bremond and Vienne, on the tone-mapped image */
    VESPER_GLARE_TEMPORAL = 3, /**< CIE, with needles and a halo that move, after Ritschel et al. 2009 */
    VESPER_GLARE_SPENCER = 4,  /**< Spencer, Shirley, Zimmerman and Greenberg 1995, with needles and halo, at `pupil` */
    VESPER_GLARE_WARD = 5      /**< the veil of Ward Larson, Rushmeier and Piatko 1997 */
} VesperGlare;

/** The eye's state of adaptation, for VESPER_GLARE_SPENCER. */
typedef enum VesperPupil {
    VESPER_PUPIL_PHOTOPIC = 0, /**< by day */
    VESPER_PUPIL_MESOPIC = 1,  /**< at dusk, and on lit roads */
    VESPER_PUPIL_SCOTOPIC = 2  /**< in the dark */
} VesperPupil;

/** What the eye adapts to. */
typedef enum VesperAdaptTo {
    VESPER_ADAPT_AS_OPERATOR = 0, /**< as the operator has it */
    VESPER_ADAPT_AVERAGE = 1,     /**< log average of the frame */
    VESPER_ADAPT_GAZE = 2,        /**< log average about the gaze */
    VESPER_ADAPT_GAZE_MEAN = 3,   /**< mean about the gaze */
    VESPER_ADAPT_TEXEL = 4        /**< one degree at the gaze, as Petit, Bremond and Vienne have it */
} VesperAdaptTo;

/** What a colour keeps that the display cannot show as bright. */
typedef enum VesperGamut {
    VESPER_GAMUT_LUMINANCE = 0,    /**< its order of luminance: it goes towards white */
    VESPER_GAMUT_CHROMATICITY = 1, /**< it is shown as bright as it can be */
    VESPER_GAMUT_CLIP = 2          /**< neither: each channel ends by itself */
} VesperGamut;

/** Most options of vesper tonemap. Begin with vesper_tone_settings_defaults: zeros are not the defaults, and some are refused. */
typedef struct VesperToneSettings {
    uint32_t size;             /**< of this structure */
    uint32_t tone_operator;    /**< a VesperOperator */
    uint32_t glare;            /**< a VesperGlare */
    uint32_t bins;             /**< of the histogram, 1 to 256 */
    float age;                 /**< of the observer, years */
    float pigmentation;        /**< of the iris: 0 very dark, 0.5 brown, 1 green, 1.2 light blue */
    float gaze[2];             /**< where the eye looks, parts of the image from its top left */
    int32_t colour_loss;       /**< dim light loses its colour (0 or 1) */
    int32_t acuity_loss;       /**< dim light is blurred as far as it cannot be resolved (0 or 1) */
    int32_t purkinje;          /**< dim light is weighted as rods do (0 or 1) */
    const char *display;       /**< name or file of a profile (docs/display.md), which is read for every picture; null: the five numbers below */
    float display_peak;        /**< luminance of white in the dark, cd/m^2 */
    float display_black;       /**< luminance of black in the dark, cd/m^2 */
    float display_ambient;     /**< illuminance on the screen, lx */
    float display_gamma;       /**< exponent */
    float display_reflection;  /**< diffuse reflectance of the screen */
    uint32_t adapt_to;         /**< a VesperAdaptTo */
    float smoothing;           /**< time constant of the curve against flicker, s; 0: none */
    float low_vision;          /**< factor on all thresholds of the observer */
    int32_t rods;              /**< rods see too, not only cones (0 or 1) */
    float histogram_low;       /**< luminance the histogram begins with, cd/m^2 */
    float histogram_high;      /**< and ends with */
    float key;                 /**< VESPER_REINHARD: what the log average is scaled to, relative to white */
    float white;               /**< VESPER_REINHARD, VESPER_LINEAR: luminance shown as white, cd/m^2; 0: the frame's maximum */
    float black;               /**< VESPER_LINEAR: luminance shown as black, cd/m^2 */
    uint32_t pupil;            /**< a VesperPupil */
    uint32_t eye_seed;         /**< VESPER_GLARE_TEMPORAL and _SPENCER: whose eye: what needles it has */
    int32_t lashes;            /**< VESPER_GLARE_TEMPORAL: the eye squints (0 or 1) */
    uint32_t gamut;            /**< a VesperGamut */
} VesperToneSettings;

/** What `vesper tonemap` does without options; `size` is that of the caller's structure. */
void vesper_tone_settings_defaults(VesperToneSettings *settings, size_t size);

/** How many bits the codes of a display have that VesperToneSettings::display may name: 8 or 10. */
VesperResult vesper_display_bits(const char *display, uint32_t *bits, VesperError *error);

/** What a frame brings besides its pixels. */
typedef struct VesperFrameReport {
    uint32_t size;        /**< of this structure; comes back as what is filled in */
    float adaptation;     /**< luminance the eye adapts to, cd/m^2 */
    float log_average;    /**< of the luminance of the frame, cd/m^2 */
    uint64_t not_finite;  /**< pixels that are NaN or infinite: shown black */
    double milliseconds;  /**< of a picture in arrays: until the device is done, on the host's clock, from when a scene that has changed is on it; of one that was handed over:
                           * what the device took for it, from its first pass to its last, on the device's clock (0: it has none) */
} VesperFrameReport;

/** Where a frame goes; what is null is not made. Buffers are the caller's, width * height * 4 values each. */
typedef struct VesperOutputs {
    uint32_t size;        /**< of this structure */
    uint8_t *codes;      /**< RGBA of the display, 8 bits; for a display of 10 bits words of A2B10G10R10 */
    float *luminance;    /**< RGBA, cd/m^2 of the scene, without glare */
    float *display_light; /**< RGBA, cd/m^2 the display would show without its limits */
    VesperFrameReport *report; /**< with its size set */
} VesperOutputs;

/** @} */

/** @name Pictures of other origin
 * @{ */

/** Maps pictures one after the other, with one eye that adapts from each to the next. */
typedef struct VesperToneMapper VesperToneMapper;

/** A picture in an array. */
typedef struct VesperPicture {
    uint32_t size;           /**< of this structure */
    uint32_t width;          /**< px */
    uint32_t height;         /**< px */
    uint32_t channels;       /**< 3 (RGB) or 4 (the fourth is ignored) */
    const float *values;     /**< width * height * channels */
    float scale;             /**< cd/m^2 of a value of 1 */
    float vertical_fov;      /**< the angle the picture covers in height, rad, where `edges` are 0 */
    float edges[4];          /**< tangents of the angles from straight ahead to the left, right, bottom and top edge, where straight ahead is
                              * not the middle, or pixels are not square; all 0: vertical_fov */
} VesperPicture;

/** Makes a tone mapper: compiles its shaders. */
VesperResult vesper_tone_mapper_create(VesperDevice *device, VesperToneMapper **mapper, VesperError *error);
/** Waits for what it still has to do, and destroys it. */
void vesper_tone_mapper_destroy(VesperToneMapper *mapper);
/** Maps a picture in an array. `seconds` have passed since the last one: the eye adapts from each to the next, also when their size changes. */
VesperResult vesper_tone_map(VesperToneMapper *mapper, const VesperToneSettings *settings, const VesperPicture *picture, float seconds,
                             const VesperOutputs *outputs, VesperError *error);
/** Forgets what the eye was adapted to, as at a cut. Waits for the picture before. */
VesperResult vesper_tone_mapper_reset(VesperToneMapper *mapper, VesperError *error);
/** Waits for the picture that vesper_tone_map_image handed over last, and reports it, once, whatever else has waited for it before; without
 * one `report` is all zero but its size. */
VesperResult vesper_tone_mapper_finish(VesperToneMapper *mapper, VesperFrameReport *report, VesperError *error);
/** Bytes of what the eye remembers. */
size_t vesper_eye_size(void);
/** What the eye remembers after the last picture, for which it waits: `bytes` of vesper_eye_size(), to be kept as they are, for the same version. */
VesperResult vesper_tone_mapper_eye(VesperToneMapper *mapper, void *bytes, VesperError *error);
/** The next picture goes on from there. Waits for the picture before. */
VesperResult vesper_tone_mapper_set_eye(VesperToneMapper *mapper, const void *bytes, size_t size, VesperError *error);

/** @} */

/** @name Scenes
 * A scene may change between two frames of its renderers, which take over what is new with the next: geometry is then uploaded
 * again, and for that moment both scenes are on the device. What only moves, dims or is switched off is told the renderer, which costs nothing.
 * Nodes keep their number for ever; those that are gone still cost some 25 ns of the host in every frame, each. Places that a host gives are of single precision: keep what is
 * seen within some 50 km of the origin.
 * @{ */

/** Meshes, materials, lamps, and the nodes they are at. */
typedef struct VesperScene VesperScene;

/** Makes a scene of nothing. */
VesperResult vesper_scene_create(VesperScene **scene, VesperError *error);
/** Reads a photometric scene (.gltf or .glb, as vesper convert writes them). */
VesperResult vesper_scene_read(const char *file, VesperScene **scene, VesperError *error);
/** Destroys a scene that no renderer draws any more. */
void vesper_scene_destroy(VesperScene *scene);
/** Nodes there are, those that were removed among them. */
uint32_t vesper_scene_node_count(const VesperScene *scene);
/** Valid until the scene changes; null where there is no such node. */
const char *vesper_scene_node_name(const VesperScene *scene, uint32_t node);

/** A surface. Set all of it: zero is a black mirror. */
typedef struct VesperMaterial {
    uint32_t size;           /**< of this structure */
    float base_colour[3];    /**< reflectance, 0 to 1; of a metal its specular one; times the texture */
    float metallic;          /**< 0 to 1 */
    float roughness;         /**< 0 to 1; 1 is matt */
    float emission[3];       /**< cd/m^2 */
    int32_t double_sided;    /**< whether its back is seen, too (0 or 1) */
    const uint8_t *texture;  /**< texture_width * texture_height * 4 codes (RGBA, sRGB); repeated; may be null */
    uint32_t texture_width;  /**< px */
    uint32_t texture_height; /**< px */
} VesperMaterial;

/** Adds a material, of which everything is copied. */
VesperResult vesper_scene_add_material(VesperScene *scene, const VesperMaterial *material, uint32_t *index, VesperError *error);

/** Triangles of one material. */
typedef struct VesperMesh {
    uint32_t size;           /**< of this structure */
    uint32_t material;       /**< of the scene */
    uint32_t vertex_count;   /**< 3 or more */
    const float *positions;  /**< 3 per vertex, m */
    const float *normals;    /**< 3 per vertex, of any length; those of none become that of the triangles around; null: every triangle is flat */
    const float *uvs;        /**< 2 per vertex; may be null */
    uint32_t index_count;    /**< a multiple of 3 */
    const uint32_t *indices; /**< three per triangle, counter-clockwise seen from the front */
} VesperMesh;

/** Adds a mesh, of which everything is copied. It is drawn where nodes have it. */
VesperResult vesper_scene_add_mesh(VesperScene *scene, const VesperMesh *mesh, uint32_t *index, VesperError *error);
/** Adds a node: with a mesh, or with VESPER_NONE to hang others on. `node_to_world`: 16 values, m; null: at the origin. */
VesperResult vesper_scene_add_node(VesperScene *scene, const char *name, uint32_t mesh, const float *node_to_world, uint32_t *node, VesperError *error);

/** A lamp: a lobe of its own, or one that was measured. */
typedef struct VesperLamp {
    uint32_t size;            /**< of this structure */
    float position[3];        /**< m */
    float axis[3];            /**< along which it shines; of a point lamp any */
    float up[3];              /**< where its +y points: C90 of an IES file, the top of a headlamp; zero: anywhere */
    float intensity;          /**< on the axis, cd; of a measured lamp a factor on its candela */
    float colour[3];          /**< scaled to luminance 1 */
    float outer_cone;         /**< half angle beyond which it is dark, rad, up to pi / 2; 0: a point lamp, without cones */
    float inner_cone;         /**< half angle of full intensity, rad */
    const char *distribution; /**< .ies, .ldt, or a laboratory's grid (.csv, .exr; docs/photometry.md), without cones; null: the cones above. Read for every lamp: one file is one distribution as long as it stays the same */
    float opening_width;     /**< along its x, m: seen as a luminous opening; 0: as the file has it, or not at all */
    float opening_height;      /**< along its y, m */
} VesperLamp;

/** Adds a lamp, at a node of its own, whose number may not be asked for (null). Scenes of up to 21,000 lamps can be rendered. */
VesperResult vesper_scene_add_lamp(VesperScene *scene, const VesperLamp *lamp, uint32_t *node, VesperError *error);
/** Hangs a node on an earlier one: it moves with that, and where it stands is meant in that one's frame from now on. */
VesperResult vesper_scene_attach(VesperScene *scene, uint32_t node, uint32_t to, VesperError *error);
/** Takes what is at a node, and what hangs on it, out of the scene; a mesh that no node has then is freed. */
VesperResult vesper_scene_remove(VesperScene *scene, uint32_t node, VesperError *error);
/** Light that comes from no lamp, in place of the scene's sky picture if it has one: on any surface, RGB lx, and where nothing is drawn, RGB cd/m^2. */
VesperResult vesper_scene_set_sky(VesperScene *scene, const float illuminance[3], const float luminance[3], VesperError *error);

/** @} */

/** @name Rendering
 * @{ */

/** Renders a scene, with one eye that adapts from frame to frame. */
typedef struct VesperRenderer VesperRenderer;

/** Takes what it needs of the scene to the device. The scene must outlive it. */
VesperResult vesper_renderer_create(VesperDevice *device, const VesperScene *scene, VesperRenderer **renderer, VesperError *error);
/** Waits for what it still has to do, and destroys it. */
void vesper_renderer_destroy(VesperRenderer *renderer);
/** Puts a node, and what hangs on it, somewhere else from now on: node frame to world, m. */
VesperResult vesper_renderer_place(VesperRenderer *renderer, uint32_t node, const float node_to_world[16], VesperError *error);
/** The lamp at a node, which has one, has its intensity times `factor` from now on; 0 switches it off. */
VesperResult vesper_renderer_dim(VesperRenderer *renderer, uint32_t node, float factor, VesperError *error);

/** Where the eye is. */
typedef struct VesperView {
    uint32_t size;            /**< of this structure */
    uint32_t width;           /**< px */
    uint32_t height;          /**< px */
    const char *camera;       /**< a camera of the scene (empty: one that has all of it before it); null: the six below */
    float eye[3];             /**< world, m */
    float forward[3];         /**< world, of any length */
    float up[3];              /**< world, of any length */
    float vertical_fov;       /**< rad, where `edges` are 0 */
    float near_plane;         /**< more than 0, m: nothing nearer is drawn */
    float edges[4];           /**< tangents of the angles from `forward` to the left, right, bottom and top edge, as of a screen that the eye is
                               * not before the middle of; all 0: vertical_fov, the same to either side */
    double scene_seconds;     /**< of the scene's animations */
} VesperView;

/** Renders into arrays. `seconds` have passed since the last frame, for the eye. */
VesperResult vesper_render(VesperRenderer *renderer, const VesperToneSettings *settings, const VesperView *view, float seconds,
                           const VesperOutputs *outputs, VesperError *error);
/** Waits for the frame that vesper_render_image handed over last, and reports it (vesper_tone_mapper_finish). */
VesperResult vesper_renderer_finish(VesperRenderer *renderer, VesperFrameReport *report, VesperError *error);
/** Forgets what the eye was adapted to, as at a camera cut. Waits for the frame before. */
VesperResult vesper_renderer_reset(VesperRenderer *renderer, VesperError *error);
/** What the eye remembers after the last frame, for which it waits (vesper_tone_mapper_eye; either takes the other's). */
VesperResult vesper_renderer_eye(VesperRenderer *renderer, void *bytes, VesperError *error);
/** The next frame goes on from there. Waits for the frame before. */
VesperResult vesper_renderer_set_eye(VesperRenderer *renderer, const void *bytes, size_t size, VesperError *error);

/** @} */

#ifdef __cplusplus
}
#endif
#endif
