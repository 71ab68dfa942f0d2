/** @file
 * Figures of what an observer sees in pictures: visible differences, contrast that a display keeps, saliency, and
 * visibility of targets (docs/embedding-vision.md).
 *
 * Pictures, settings, units and errors are those of vesper.h. Pixels that are not finite are black, and negative
 * luminances are 0. Every call sees its pictures anew: no figure depends on the calls before.
 *
 * SPDX-License-Identifier: MIT
 */
#ifndef VESPER_VISION_H
#define VESPER_VISION_H

#include <vesper/vesper.h>

#ifdef __cplusplus
extern "C" {
#endif

/** @name Pictures as an observer sees them
 * @{ */

/** Computes figures of pictures, one after the other. */
typedef struct VesperVision VesperVision;

/** Makes a vision and compiles its shaders. */
VesperResult vesper_vision_create(VesperDevice* device, VesperVision** vision, VesperError* error);
/** Destroys a vision. */
void vesper_vision_destroy(VesperVision* vision);

/** Who looks. Set all fields. Null in place of it: 23 years, 0.5, and light is scattered. */
typedef struct VesperObserver {
    uint32_t size;      /**< of this structure */
    float age;          /**< years, 1 to 120 */
    float pigmentation; /**< of the iris, 0 to 1.5, as VesperToneSettings::pigmentation */
    int32_t scattered;  /**< 1: the pictures are those on the retina, with the light that this eye scatters already; 0:
                         * it is added, by the CIE total glare function */
} VesperObserver;

/** Differences of two pictures that an observer detects. */
typedef struct VesperDifferences {
    uint32_t size;    /**< of this structure; on return the size that is filled in */
    uint32_t x;       /**< of the largest difference, px from the left */
    uint32_t y;       /**< of the largest difference, px from the top */
    float largest;    /**< probability of detection, of all pixels, 0 to 1 */
    float above_half; /**< share of the pixels with a probability above 0.5 */
    float above_75;   /**< share of the pixels with a probability above 0.75 */
    float above_95;   /**< share of the pixels with a probability above 0.95 */
} VesperDifferences;

/** Finds where an observer tells two pictures apart, as `vesper compare` does (docs/compare.md; after Mantiuk, Daly,
 * Myszkowski and Seidel 2005). Both have the same size, at most 2^24 pixels, the same angle within 0.1 %, which is
 * 0.1 to 170 degrees in height, and square pixels within 1 %. Pictures of less than 4 degrees are seen with margins as
 * large as they are, and need four times the memory and time of others: beyond 2^25 pixels with these, or a minute,
 * the result is VESPER_FAILED. `probability`: width * height values, 0 to 1, that an eye that looks there detects a
 * difference. Outputs that are null are not made. */
VesperResult vesper_visible_differences(VesperVision* vision, const VesperObserver* observer,
                                        const VesperPicture* first, const VesperPicture* second, float* probability,
                                        VesperDifferences* found, VesperError* error);

/** Buffers of the caller, width * height values each, 0 to 1: by pixel the share of the octaves of frequency in which
 * contrast is ... Null outputs are not made. */
typedef struct VesperFidelity {
    uint32_t size;    /**< of this structure */
    float* seen;      /**< seen in the scene: 2 thresholds and more */
    float* lost;      /**< seen in the scene and below 1 threshold on the display */
    float* invented;  /**< seen on the display and below 1 threshold in the scene */
    float* amplified; /**< seen in the scene, and twice as many thresholds on the display */
} VesperFidelity;

/** Finds what a display shows of the contrast of a scene, each seen by an eye that is adapted to it (after Aydin,
 * Mantiuk, Myszkowski and Seidel 2008). Pictures as for vesper_visible_differences; `shown` is the light of the display
 * (vesper_light_of_codes). */
VesperResult vesper_contrast_fidelity(VesperVision* vision, const VesperObserver* observer, const VesperPicture* scene,
                                      const VesperPicture* shown, const VesperFidelity* maps, VesperError* error);

/** Finds how much places draw the eye (docs/saliency.md; after Itti, Koch and Niebur 1998 and Petit, Bremond and Tarel
 * 2009). `map`: texels of 16 px, ((width + 15) / 16) * ((height + 15) / 16) values from 0 to 1, rows from the top;
 * those of two pictures have no common scale. Pictures have 32 px or more on a side; below 256 px fewer levels are
 * compared. Their angle has no influence, and pixels that are not finite do not count. */
VesperResult vesper_saliency(VesperVision* vision, const VesperPicture* picture, float* map, VesperError* error);

/** @} */

/** @name Luminances
 * These need no device and may be called from any thread.
 * @{ */

/** Computes the light of codes on the display of `settings`, within its limits of gamut and peak and with the light
 * that it reflects. `codes`: width * height * 4 bytes, as VesperOutputs::codes. `light`: width * height * 3 values,
 * RGB, cd/m^2. */
VesperResult vesper_light_of_codes(const VesperToneSettings* settings, uint32_t width, uint32_t height,
                                   const uint8_t* codes, float* light, VesperError* error);

/** A small uniform target, and how it is looked at. Set all fields. Null in place of it: 10 arc minutes, 0.2 s, 23
 * years, no veil. */
typedef struct VesperTarget {
    uint32_t size;     /**< of this structure */
    float arc_minutes; /**< diameter, 1 to 60 arc minutes */
    float seconds;     /**< time of observation, 0.01 to 1e6 s; from 2 s on without limit */
    float age;         /**< of the observer, 1 to 120 years; below 23 as 23 */
    float veil;        /**< veiling luminance over target and background, 0 to 1e9 cd/m^2 */
} VesperTarget;

/** Computes visibility levels (Adrian 1989): the difference of luminance over the least that is detected for certain,
 * negative where the target is darker. Arrays of `count` values: `luminance` of the target, 0 to 1e9 cd/m^2;
 * `background`, the same, and 1e-6 cd/m^2 or more together with the veil. `levels` may be one of them. */
VesperResult vesper_visibility_levels(const VesperTarget* target, size_t count, const float* luminance,
                                      const float* background, float* levels, VesperError* error);

/** @} */

#ifdef __cplusplus
}
#endif
#endif
