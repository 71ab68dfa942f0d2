/** @file
 * Vesper for other programs and languages: photometric night rendering and tone mapping.
 *
 * There is no global state. The caller owns every object that a call makes and destroys it: first the objects made from
 * a device, then the device. Destroying a null pointer does nothing. A device and the objects made from it belong to
 * one thread at a time; different devices may be used at the same time.
 *
 * A call that can fail returns a VesperResult. If it fails and `error` is not null, `error` holds one line with file,
 * place and reason; outputs are unchanged. A null pointer to settings means the defaults. Structures begin with their
 * size: set it with VESPER_INIT, which zeroes the other fields, or with a `vesper_*_defaults` function. New fields are
 * added at the end only.
 *
 * Units: metres, seconds, radians, lux, cd/m^2, candela. Colours are linear Rec. 709. Images have their first row at
 * the top. Matrices are column by column, y is up, lamps and cameras look along their -z.
 *
 * SPDX-License-Identifier: MIT
 */
#ifndef VESPER_VESPER_H
#define VESPER_VESPER_H

#include <stddef.h>
#include <stdint.h>

#include <vesper/operators.h>

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
 * Version of the interface in this header (semantic versioning, docs/embedding.md).
 * @{ */
#define VESPER_VERSION_MAJOR 0 /**< changes when a function or field is removed */
#define VESPER_VERSION_MINOR 1 /**< changes when one is added, and before 1.0 also when one is removed */
#define VESPER_VERSION_PATCH 0 /**< changes with corrections */
/** @} */

/** Sets the major, minor and patch number of the linked library. Null is ignored. */
void vesper_version(uint32_t version[3]);

/** Result of a call. */
typedef enum VesperResult {
    VESPER_OK = 0,                   /**< success */
    VESPER_BAD_ARGUMENT = 1,         /**< a null pointer, or a size or number out of range */
    VESPER_FAILED = 2,               /**< a file, a display or the device failed: see the message */
    VESPER_OUT_OF_MEMORY = 3,        /**< no memory of the host */
    VESPER_OUT_OF_DEVICE_MEMORY = 4, /**< no memory of the device; all objects stay usable, smaller pictures may fit */
    VESPER_DEVICE_LOST = 5           /**< objects of the device can only be destroyed; a new device may work */
} VesperResult;

/** Message of a failed call. */
typedef struct VesperError {
    char message[1024]; /**< one line of English, zero-terminated, truncated if too long */
} VesperError;

/** Initializer of a structure with its size set and all other fields zero: VesperView view =
 * VESPER_INIT(VesperView). */
#ifdef __cplusplus
#define VESPER_INIT(type) vesper_init<type>()
#else
#define VESPER_INIT(type) \
    { .size = sizeof(type) }
#endif

/** Index of no object. */
#define VESPER_NONE 0xffffffffu

/** @name Devices
 * @{ */

/** A Vulkan device, opened by Vesper or borrowed from its host (vesper/vulkan.h). */
typedef struct VesperDevice VesperDevice;

/** Choice of a device, and its validation. */
typedef struct VesperDeviceOptions {
    uint32_t size; /**< of this structure */
    const char*
        select; /**< part of a name, "cpu", or an index; null: the environment's VESPER_DEVICE, else the best device */
    int32_t validation; /**< 1: the Khronos validation layer, which must be installed, checks all calls */
    void (*on_message)(const char* message,
                       void* user); /**< called for each message of the layer, on any thread; may be null */
    void* user;                     /**< passed to on_message */
} VesperDeviceOptions;

/** Opens a Vulkan 1.3 device. `options` may be null. */
VesperResult vesper_device_open(const VesperDeviceOptions* options, VesperDevice** device, VesperError* error);
/** Closes a device after all its objects are destroyed. A borrowed Vulkan device stays open. */
void vesper_device_close(VesperDevice* device);
/** Name of the device; valid until the device is closed. */
const char* vesper_device_name(const VesperDevice* device);

/** @} */

/** @name Tone mapping settings
 * @{ */

/** Tone operators (docs/tone.md), by the names of vesper/operators.h: VESPER_IRAWAN is 0. VESPER_LDR shows no
 * luminances and is refused. */
typedef enum VesperOperator {
/** @cond */
#define VESPER_OPERATOR_VALUE(NAME, Name, name, value, summary) VESPER_##NAME = (value),
    VESPER_OPERATORS(VESPER_OPERATOR_VALUE)
#undef VESPER_OPERATOR_VALUE
    /** @endcond */
} VesperOperator;

/** Light scattered in the eye before it adapts (docs/glare.md). */
typedef enum VesperGlare {
    VESPER_GLARE_NONE = 0,     /**< no scattered light */
    VESPER_GLARE_CIE = 1,      /**< CIE total glare function (CIE 135/1, 1999) of an eye of `age` and `pigmentation` */
    VESPER_GLARE_LDR = 2,      /**< bloom of Petit, Bremond and Vienne, on the tone-mapped image */
    VESPER_GLARE_TEMPORAL = 3, /**< CIE with moving needles and halo, after Ritschel et al. 2009 */
    VESPER_GLARE_SPENCER = 4,  /**< Spencer, Shirley, Zimmerman and Greenberg 1995, with needles and halo, at `pupil` */
    VESPER_GLARE_WARD = 5      /**< the veil of Ward Larson, Rushmeier and Piatko 1997 */
} VesperGlare;

/** The eye's state of adaptation, for VESPER_GLARE_SPENCER. */
typedef enum VesperPupil {
    VESPER_PUPIL_PHOTOPIC = 0, /**< by day */
    VESPER_PUPIL_MESOPIC = 1,  /**< at dusk, and on lit roads */
    VESPER_PUPIL_SCOTOPIC = 2  /**< in the dark */
} VesperPupil;

/** Luminance that the eye adapts to. */
typedef enum VesperAdaptTo {
    VESPER_ADAPT_AS_OPERATOR = 0, /**< the default of the operator */
    VESPER_ADAPT_AVERAGE = 1,     /**< log average of the frame */
    VESPER_ADAPT_GAZE = 2,        /**< log average around the gaze */
    VESPER_ADAPT_GAZE_MEAN = 3,   /**< mean around the gaze */
    VESPER_ADAPT_TEXEL = 4        /**< mean of one degree at the gaze (Petit, Bremond and Vienne) */
} VesperAdaptTo;

/** Treatment of colours that are brighter than the display can show. */
typedef enum VesperGamut {
    VESPER_GAMUT_LUMINANCE = 0,    /**< keeps the order of luminance: chroma goes towards white */
    VESPER_GAMUT_CHROMATICITY = 1, /**< keeps chromaticity: luminance is limited */
    VESPER_GAMUT_CLIP = 2          /**< limits each channel by itself */
} VesperGamut;

/** Settings of tone mapping, as the options of vesper tonemap. Begin with vesper_tone_settings_defaults: some zeros are
 * refused. */
typedef struct VesperToneSettings {
    uint32_t size;            /**< of this structure */
    uint32_t tone_operator;   /**< a VesperOperator */
    uint32_t glare;           /**< a VesperGlare */
    uint32_t bins;            /**< of the histogram, 1 to 256 */
    float age;                /**< of the observer, years */
    float pigmentation;       /**< of the iris: 0 very dark, 0.5 brown, 1 green, 1.2 light blue */
    float gaze[2];            /**< where the eye looks, parts of the image from its top left */
    int32_t colour_loss;      /**< 1: dim light loses its colour */
    int32_t acuity_loss;      /**< 1: dim light is blurred to the resolution of the eye */
    int32_t purkinje;         /**< 1: dim light has the weights of rods */
    const char* display;      /**< name or file of a profile (docs/display.md), read again when its time or size has
                               * changed; null: the five numbers below */
    float display_peak;       /**< luminance of white in the dark, cd/m^2 */
    float display_black;      /**< luminance of black in the dark, cd/m^2 */
    float display_ambient;    /**< illuminance on the screen, lx */
    float display_gamma;      /**< exponent */
    float display_reflection; /**< diffuse reflectance of the screen */
    uint32_t adapt_to;        /**< a VesperAdaptTo */
    float smoothing;          /**< time constant of the curve against flicker, s; 0: none */
    float low_vision;         /**< factor on all thresholds of the observer */
    int32_t rods;             /**< 1: rods see, too */
    float histogram_low;      /**< least luminance of the histogram, cd/m^2 */
    float histogram_high;     /**< greatest luminance of the histogram, cd/m^2 */
    float key;                /**< VESPER_REINHARD: displayed log average, relative to white */
    float white;              /**< VESPER_REINHARD, VESPER_LINEAR: luminance shown as white, cd/m^2; 0: the frame's
                               * maximum */
    float black;              /**< VESPER_LINEAR: luminance shown as black, cd/m^2 */
    uint32_t pupil;           /**< a VesperPupil */
    uint32_t eye_seed;        /**< VESPER_GLARE_TEMPORAL and _SPENCER: selects the needles of the eye */
    int32_t lashes;           /**< VESPER_GLARE_TEMPORAL: 1: the eye squints */
    uint32_t gamut;           /**< a VesperGamut */
    const char* options; /**< settings by name (docs/tone-settings.md), separated by spaces: "bias=0.7 adapt-to=texel
                          * rods=on". They overrule the fields above. Null: none */
} VesperToneSettings;

/** Sets the defaults of `vesper tonemap`. `size`: sizeof the caller's structure. */
void vesper_tone_settings_defaults(VesperToneSettings* settings, size_t size);

/** Sets the bits of a code, 8 or 10, of a display (name or file, as VesperToneSettings::display). */
VesperResult vesper_display_bits(const char* display, uint32_t* bits, VesperError* error);

/** Figures of a frame. */
typedef struct VesperFrameReport {
    uint32_t size;       /**< of this structure; on return the size that is filled in */
    float adaptation;    /**< luminance of adaptation, cd/m^2 */
    float log_average;   /**< log average of the luminance of the frame, cd/m^2 */
    uint64_t not_finite; /**< pixels that are NaN or infinite: shown black */
    double milliseconds; /**< picture in arrays: time on the host's clock until the device is done, without the upload
                          * of a changed scene. Picture in images: time from its first pass to its last on the device's
                          * clock (0: the device has no clock) */
} VesperFrameReport;

/** Buffers of the caller for a frame, width * height * 4 values each. Null outputs are not made. */
typedef struct VesperOutputs {
    uint32_t size;             /**< of this structure */
    uint8_t* codes;            /**< RGBA of the display, 8 bits; for a display of 10 bits words of A2B10G10R10 */
    float* luminance;          /**< RGBA, cd/m^2 of the scene, without glare */
    float* display_light;      /**< RGBA, cd/m^2 of the display without its limits of gamut and peak */
    VesperFrameReport* report; /**< its size must be set */
} VesperOutputs;

/** @} */

/** @name Tone mapping of pictures
 * @{ */

/** Maps a series of pictures with one eye, which adapts from each to the next. */
typedef struct VesperToneMapper VesperToneMapper;

/** A picture in an array. */
typedef struct VesperPicture {
    uint32_t size;       /**< of this structure */
    uint32_t width;      /**< px */
    uint32_t height;     /**< px */
    uint32_t channels;   /**< 3 (RGB) or 4 (the fourth is ignored) */
    const float* values; /**< width * height * channels */
    float scale;         /**< cd/m^2 of a value of 1 */
    float vertical_fov;  /**< angle of the picture's height, rad; used if all `edges` are 0 */
    float edges[4];      /**< tangents of the angles from straight ahead to the left, right, bottom and top edge,
                          * for off-axis pictures and pixels that are not square; all 0: vertical_fov */
} VesperPicture;

/** Makes a tone mapper and compiles its shaders. */
VesperResult vesper_tone_mapper_create(VesperDevice* device, VesperToneMapper** mapper, VesperError* error);
/** Waits for submitted pictures and destroys the tone mapper. */
void vesper_tone_mapper_destroy(VesperToneMapper* mapper);
/** Maps a picture in an array. `seconds`: time since the last picture, for the adaptation of the eye. Sizes may
 * differ. */
VesperResult vesper_tone_map(VesperToneMapper* mapper, const VesperToneSettings* settings, const VesperPicture* picture,
                             float seconds, const VesperOutputs* outputs, VesperError* error);
/** Resets the eye's state, as at a cut. Waits for the picture before. */
VesperResult vesper_tone_mapper_reset(VesperToneMapper* mapper, VesperError* error);
/** Waits for the last picture of vesper_tone_map_image and fills `report`. A picture is reported once; without a new
 * one `report` is zero except its size. */
VesperResult vesper_tone_mapper_finish(VesperToneMapper* mapper, VesperFrameReport* report, VesperError* error);
/** Bytes of the eye's state. */
size_t vesper_eye_size(void);
/** Waits for the last picture and copies the eye's state, vesper_eye_size() bytes, for the same version of the
 * library. */
VesperResult vesper_tone_mapper_eye(VesperToneMapper* mapper, void* bytes, VesperError* error);
/** Sets the eye's state for the next picture. Waits for the picture before. */
VesperResult vesper_tone_mapper_set_eye(VesperToneMapper* mapper, const void* bytes, size_t size, VesperError* error);

/** @} */

/** @name Scenes
 * A scene may change between two frames. Its renderers upload it again with their next frame; both versions are on the
 * device for that moment. To move a node or dim a lamp use the renderer, without an upload. Nodes keep their numbers
 * for ever; a removed node costs 25 ns of the host per frame. Positions are of single precision: keep visible objects
 * within 50 km of the origin.
 * @{ */

/** Meshes, materials, lamps, and their nodes. */
typedef struct VesperScene VesperScene;

/** Makes an empty scene. */
VesperResult vesper_scene_create(VesperScene** scene, VesperError* error);
/** Reads a photometric scene (.gltf or .glb, as vesper convert writes them). Files that it names lie in its folder. */
VesperResult vesper_scene_read(const char* file, VesperScene** scene, VesperError* error);
/** The same. Files that it names may lie in `folder`, too; "/" is everywhere. */
VesperResult vesper_scene_read_allowing(const char* file, const char* folder, VesperScene** scene, VesperError* error);
/** Destroys a scene. Its renderers must be destroyed before. */
void vesper_scene_destroy(VesperScene* scene);
/** Number of nodes, including removed ones. */
uint32_t vesper_scene_node_count(const VesperScene* scene);
/** Name of a node, valid until the scene changes; null if the node does not exist. */
const char* vesper_scene_node_name(const VesperScene* scene, uint32_t node);

/** A surface. Set all fields: zeros are a black mirror. */
typedef struct VesperMaterial {
    uint32_t size;           /**< of this structure */
    float base_colour[3];    /**< reflectance, 0 to 1 (of a metal: specular); times the texture */
    float metallic;          /**< 0 to 1 */
    float roughness;         /**< 0 to 1; 1 is matt */
    float emission[3];       /**< cd/m^2 */
    int32_t double_sided;    /**< 1: the back is visible, too */
    const uint8_t* texture;  /**< texture_width * texture_height * 4 codes (RGBA, sRGB); repeated; may be null */
    uint32_t texture_width;  /**< px */
    uint32_t texture_height; /**< px */
} VesperMaterial;

/** Copies a material into the scene and sets its index. */
VesperResult vesper_scene_add_material(VesperScene* scene, const VesperMaterial* material, uint32_t* index,
                                       VesperError* error);

/** Triangles of one material. */
typedef struct VesperMesh {
    uint32_t size;           /**< of this structure */
    uint32_t material;       /**< of the scene */
    uint32_t vertex_count;   /**< 3 or more */
    const float* positions;  /**< 3 per vertex, m */
    const float* normals;    /**< 3 per vertex, of any length; zero: mean of the triangles around; null: flat */
    const float* uvs;        /**< 2 per vertex; may be null */
    uint32_t index_count;    /**< a multiple of 3 */
    const uint32_t* indices; /**< three per triangle, counter-clockwise seen from the front */
} VesperMesh;

/** Copies a mesh into the scene and sets its index. It is drawn at the nodes that have it. */
VesperResult vesper_scene_add_mesh(VesperScene* scene, const VesperMesh* mesh, uint32_t* index, VesperError* error);
/** Adds a node with a mesh, or with VESPER_NONE as a parent of others. `node_to_world`: 16 values, m; null: at the
 * origin. */
VesperResult vesper_scene_add_node(VesperScene* scene, const char* name, uint32_t mesh, const float* node_to_world,
                                   uint32_t* node, VesperError* error);

/** A lamp: a cone, or a measured distribution. */
typedef struct VesperLamp {
    uint32_t size;            /**< of this structure */
    float position[3];        /**< m */
    float axis[3];            /**< direction of the light; any for a point lamp */
    float up[3];              /**< direction of its +y: C90 of an IES file, the top of a headlamp; zero: any */
    float intensity;          /**< on the axis, cd; measured lamp: factor on its candela */
    float colour[3];          /**< scaled to luminance 1 */
    float outer_cone;         /**< half angle of no intensity, rad, up to pi / 2; 0: a point lamp */
    float inner_cone;         /**< half angle of full intensity, rad */
    const char* distribution; /**< file: .ies, .ldt, or a grid (.csv, .exr; docs/distributions.md), in place of the
                               * cones; null: the cones. Read for every lamp; lamps of an unchanged file share one
                               * distribution */
    float opening_width;      /**< of the luminous opening along its x, m; 0: as the file states, or none */
    float opening_height;     /**< of the luminous opening along its y, m */
} VesperLamp;

/** Adds a lamp at a new node and sets its number, unless `node` is null. A scene can be rendered with at most 21,000
 * lamps. */
VesperResult vesper_scene_add_lamp(VesperScene* scene, const VesperLamp* lamp, uint32_t* node, VesperError* error);
/** Makes an earlier node the parent of a node. The node's transform is then relative to its parent. */
VesperResult vesper_scene_attach(VesperScene* scene, uint32_t node, uint32_t to, VesperError* error);
/** Removes a node, its mesh or lamp, and its children. A mesh without nodes is freed. */
VesperResult vesper_scene_remove(VesperScene* scene, uint32_t node, VesperError* error);
/** Sets ambient illuminance on all surfaces, RGB lx, and luminance of the background, RGB cd/m^2. Replaces a sky
 * picture. */
VesperResult vesper_scene_set_sky(VesperScene* scene, const float illuminance[3], const float luminance[3],
                                  VesperError* error);

/** @} */

/** @name Rendering
 * @{ */

/** Renders a scene with one eye, which adapts from frame to frame. */
typedef struct VesperRenderer VesperRenderer;

/** Makes a renderer and uploads the scene, which must outlive it. */
VesperResult vesper_renderer_create(VesperDevice* device, const VesperScene* scene, VesperRenderer** renderer,
                                    VesperError* error);
/** Waits for submitted frames and destroys the renderer. */
void vesper_renderer_destroy(VesperRenderer* renderer);
/** Sets the transform of a node, with its children, for all later frames: node frame to world, m. */
VesperResult vesper_renderer_place(VesperRenderer* renderer, uint32_t node, const float node_to_world[16],
                                   VesperError* error);
/** Scales the intensity of the lamp at a node, and the luminance that its mesh emits, for all later frames; 0 switches
 * them off. The node must have one of them. */
VesperResult vesper_renderer_dim(VesperRenderer* renderer, uint32_t node, float factor, VesperError* error);

/** Keeps shadow maps of what stands still, and light between surfaces, in a folder, which is made, for later runs.
 * Files there take at most 1 GiB; those that were used longest ago are removed. `folder`: null: nowhere, which is the
 * default. Pictures are the same with and without, also where a disk is full. VESPER_FAILED: nothing can be written
 * there. */
VesperResult vesper_renderer_set_cache(VesperRenderer* renderer, const char* folder, VesperError* error);

/** Told how much is done, 0 to 1; returns 0 to end the work. */
typedef int32_t (*VesperProgress)(double share, void* user);

/** Gathers the light that surfaces at rest get from emitting surfaces and from the sky, and by way of each other, for
 * all later frames (radiosity; in place of the scene's ambient illuminance). Nodes that were placed, or are animated,
 * get it and hide it, but send none. Those that are placed later send none from then on, but still reflect and hide it
 * where they were. It takes up to minutes on all processors, and much less where
 * vesper_renderer_set_cache names a folder that has it. Lamps and meshes may be dimmed afterwards; after any other
 * change of the scene frames go without it until it is gathered again. `progress`: null: nobody is told; called from
 * this thread with `user`; it must not call other functions with this renderer or its scene. VESPER_FAILED: it ended
 * the work. */
VesperResult vesper_renderer_gather_light(VesperRenderer* renderer, VesperProgress progress, void* user,
                                          VesperError* error);

/** Kind of a setting's values. */
typedef enum VesperSettingKind {
    VESPER_SETTING_SWITCH = 0, /**< 0: off, 1: on */
    VESPER_SETTING_COUNT = 1,  /**< a whole number */
    VESPER_SETTING_NUMBER = 2  /**< a real number */
} VesperSettingKind;

/** A setting of how renderers make light (docs/quality.md). Texts are valid for ever. */
typedef struct VesperSetting {
    uint32_t size;      /**< of this structure */
    uint32_t kind;      /**< a VesperSettingKind */
    const char* name;   /**< as options of `vesper render`, without the first dashes: "shadow-error" */
    const char* unit;   /**< "lx", or empty */
    const char* help;   /**< one line */
    double low;         /**< least value */
    double high;        /**< greatest value */
    double fast;        /**< value in the set "fast" */
    double standard;    /**< value in the set "standard", and of a new renderer */
    double exact;       /**< value in the set "exact" */
    double interactive; /**< value in the set "interactive" */
} VesperSetting;

/** Number of settings. */
uint32_t vesper_setting_count(void);
/** Sets `setting`, whose size must be set, to the one of an index below vesper_setting_count(). */
VesperResult vesper_setting_at(uint32_t index, VesperSetting* setting, VesperError* error);
/** Sets a value by the name of its setting for all later frames. It holds in every set of vesper_set_quality.
 * VESPER_BAD_ARGUMENT: there is no such setting, or the value is out of its range; the message says which. */
VesperResult vesper_set(VesperRenderer* renderer, const char* name, double value, VesperError* error);
/** Back to the value that the set has. */
VesperResult vesper_unset(VesperRenderer* renderer, const char* name, VesperError* error);
/** Gets the value that the next frame will have. */
VesperResult vesper_get(const VesperRenderer* renderer, const char* name, double* value, VesperError* error);
/** Takes the set "fast", "interactive", "standard" or "exact" for all settings without a value of vesper_set.
 * VESPER_BAD_ARGUMENT: there is no such set; the message lists them. */
VesperResult vesper_set_quality(VesperRenderer* renderer, const char* quality, VesperError* error);

/** Position and angles of the eye, and size of the picture. */
typedef struct VesperView {
    uint32_t size;        /**< of this structure */
    uint32_t width;       /**< px */
    uint32_t height;      /**< px */
    const char* camera;   /**< name of a camera of the scene; empty: a view of the whole scene; null: the six fields
                           * below */
    float eye[3];         /**< world, m */
    float forward[3];     /**< world, of any length */
    float up[3];          /**< world, of any length */
    float vertical_fov;   /**< rad; used if all `edges` are 0 */
    float near_plane;     /**< nearest drawn distance, m, above 0 */
    float edges[4];       /**< tangents of the angles from `forward` to the left, right, bottom and top edge, for an
                           * off-axis screen; all 0: vertical_fov, symmetric */
    double scene_seconds; /**< time of the scene's animations, s */
} VesperView;

/** Renders into arrays. `seconds`: time since the last frame, for the adaptation of the eye. */
VesperResult vesper_render(VesperRenderer* renderer, const VesperToneSettings* settings, const VesperView* view,
                           float seconds, const VesperOutputs* outputs, VesperError* error);
/** Waits for the last frame of vesper_render_image and fills `report`, as vesper_tone_mapper_finish. */
VesperResult vesper_renderer_finish(VesperRenderer* renderer, VesperFrameReport* report, VesperError* error);
/** Resets the eye's state, as at a camera cut. Waits for the frame before. */
VesperResult vesper_renderer_reset(VesperRenderer* renderer, VesperError* error);
/** Waits for the last frame and copies the eye's state, as vesper_tone_mapper_eye. Both kinds of states are the
 * same. */
VesperResult vesper_renderer_eye(VesperRenderer* renderer, void* bytes, VesperError* error);
/** Sets the eye's state for the next frame. Waits for the frame before. */
VesperResult vesper_renderer_set_eye(VesperRenderer* renderer, const void* bytes, size_t size, VesperError* error);

/** @} */

/** @name One eye before several screens
 * The stages of a frame one by one: look at each view, adapt to all of them, show each. Pictures stay on the device.
 * Every view scatters its own light in the eye; what one scatters into another is left out.
 * @{ */

/** The eye that sees several views at once. */
typedef struct VesperSharedEye VesperSharedEye;

/** Makes an eye of 1 to 16 views. */
VesperResult vesper_shared_eye_create(VesperDevice* device, uint32_t views, VesperSharedEye** eye, VesperError* error);
/** Destroys a shared eye. */
void vesper_shared_eye_destroy(VesperSharedEye* eye);
/** Renders what view `index` sees. `settings` as of vesper_render; VESPER_LDR is refused. */
VesperResult vesper_shared_eye_look(VesperSharedEye* eye, uint32_t index, VesperRenderer* renderer,
                                    const VesperToneSettings* settings, const VesperView* view, VesperError* error);
/** Scatters the light of all views in the eye and adapts it: to the luminance where it looks in view `looked_at`, and
 * to the luminances of all. All were looked at since the last adaptation, `seconds` ago. Fills `report`, which may be
 * null. */
VesperResult vesper_shared_eye_adapt(VesperSharedEye* eye, const VesperToneSettings* settings, uint32_t looked_at,
                                     float seconds, VesperFrameReport* report, VesperError* error);
/** Shows a view as the eye has adapted, on the display of `settings`. Of `outputs` the codes and the light of the
 * display may be wanted; the others must be null. */
VesperResult vesper_shared_eye_show(VesperSharedEye* eye, uint32_t index, const VesperToneSettings* settings,
                                    const VesperOutputs* outputs, VesperError* error);
/** Resets the eye's state, as at a cut. */
VesperResult vesper_shared_eye_reset(VesperSharedEye* eye, VesperError* error);

/** @} */

#ifdef __cplusplus
}
#endif
#endif
