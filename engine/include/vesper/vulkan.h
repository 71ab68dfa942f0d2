/** @file
 * Vesper on a Vulkan device of its host's, with the host's images.
 *
 * The host makes the device as vesper_device_extensions and vesper_device_features say, and hands it over. Vesper calls the functions
 * of the Vulkan loader of the process (libvulkan.so.1), whichever way the host calls them (linked, or by volk).
 *
 * Rules. The host keeps everything it hands over alive until what uses it is done (images, semaphores) or the VesperDevice is closed, and
 * destroys it itself. The queue is used inside of vesper_tone_map*, vesper_render* and vesper_renderer_create; where other threads
 * use it at the same time, lock_queue and unlock_queue keep them apart. Vesper never waits for the queue to be idle; but what has to be on the
 * device before it can be used (a scene, when a renderer is made or takes over changes) goes through the queue, behind what is there.
 * A call that fails has handed nothing over: it waits for no semaphore and signals none.
 *
 * Images of the host's are 2D; the first level of their first layer is used. They belong to the queue's family, or are shared by
 * families (VK_SHARING_MODE_CONCURRENT). What was handed to the same queue before a call is done before Vesper begins, and what is handed
 * to it afterwards waits until Vesper is done, memory and layouts included: semaphores are for other queues, and for presentation.
 *
 * SPDX-License-Identifier: MIT
 */
#ifndef VESPER_VULKAN_H
#define VESPER_VULKAN_H

#include <vulkan/vulkan_core.h>

#include <vesper/vesper.h>

#ifdef __cplusplus
extern "C" {
#endif

/** @name Devices of the host's
 * @{ */

/** Names of the device extensions that a device must be made with; they stay valid. Its instance is made for Vulkan 1.3. */
const char *const *vesper_device_extensions(uint32_t *count);
/** Sets the features that a device must be made with, and leaves others as they are. The chain of `features` holds the structures of
 * Vulkan 1.2 and 1.3, or those of the extensions that became part of these. Fails where the device cannot do, and names all that it lacks. */
VesperResult vesper_device_features(VkPhysicalDevice physical_device, VkPhysicalDeviceFeatures2 *features, VesperError *error);

/** A device that the host made. */
typedef struct VesperHostDevice {
    uint32_t size;                         /**< of this structure */
    uint32_t api_version;                  /**< of the instance (VkApplicationInfo::apiVersion) */
    VkInstance instance;                   /**< of the device */
    VkPhysicalDevice physical_device;      /**< of the device */
    VkDevice device;                       /**< to be used */
    const VkDeviceCreateInfo *created_with; /**< what vkCreateDevice was given: extensions, features and queues; read during the call only */
    VkQueue queue;                         /**< for graphics and compute */
    uint32_t queue_family;                 /**< of the queue */
    void (*lock_queue)(void *user);        /**< before the queue is used; may be null */
    void (*unlock_queue)(void *user);      /**< afterwards; null as lock_queue */
    void *user;                            /**< handed to both */
} VesperHostDevice;

/** Borrows a device. Fails where it was made without something that Vesper needs, and names all of that. */
VesperResult vesper_device_borrow(const VesperHostDevice *host, VesperDevice **device, VesperError *error);

/** @} */

/** @name Images of the host's
 * @{ */

/** An image, and its layouts around a call. */
typedef struct VesperImage {
    uint32_t size;               /**< of this structure */
    VkImage image;               /**< a picture is made with VK_IMAGE_USAGE_SAMPLED_BIT, one to be shown with _TRANSFER_DST_BIT */
    VkFormat format;             /**< of a picture: rgba32f, rgba16f, b10g11r11 or e5b9g9r9; of one to be shown: RGBA or BGRA of 8 bits (UNORM or
                                  * SRGB) or 10 bits. Codes of the display are copied to it as they are, with as many bits as it has */
    uint32_t width;              /**< px */
    uint32_t height;             /**< px */
    VkImageLayout layout_before; /**< when the call's work begins: one that colours can have; of an image to be shown VK_IMAGE_LAYOUT_UNDEFINED will do */
    VkImageLayout layout_after;  /**< when it is done; of an image of a swapchain VK_IMAGE_LAYOUT_PRESENT_SRC_KHR */
    uint32_t reserved;           /**< 0 */
} VesperImage;

/** Semaphores around a call's work, for what happens on other queues. Both lists may be empty. */
typedef struct VesperHandover {
    uint32_t size;                         /**< of this structure */
    uint32_t wait_count;                   /**< of `waits` */
    uint32_t signal_count;                 /**< of `signals` */
    const VkSemaphoreSubmitInfo *waits;    /**< binary or timeline, before it */
    const VkSemaphoreSubmitInfo *signals;  /**< and after it */
} VesperHandover;

/** A picture in an image. */
typedef struct VesperImagePicture {
    uint32_t size;            /**< of this structure */
    const VesperImage *image; /**< linear Rec. 709 */
    float scale;              /**< cd/m^2 of a value of 1 */
    float vertical_fov;       /**< the angle the picture covers in height, rad, where `edges` are 0 */
    float edges[4];           /**< as of VesperPicture */
} VesperImagePicture;

/** As vesper_tone_map, from an image to an image of the same extent. Hands its work to the queue and returns; at most three pictures are on their
 * way at once. Waits only for the picture before where sizes or settings have changed, and with glare that moves (VESPER_GLARE_TEMPORAL, _SPENCER).
 * `handover` may be null. */
VesperResult vesper_tone_map_image(VesperToneMapper *mapper, const VesperToneSettings *settings, const VesperImagePicture *picture, float seconds,
                                   const VesperImage *shown, const VesperHandover *handover, VesperError *error);
/** As vesper_render, into an image of the view's extent; likewise. */
VesperResult vesper_render_image(VesperRenderer *renderer, const VesperToneSettings *settings, const VesperView *view, float seconds,
                                 const VesperImage *shown, const VesperHandover *handover, VesperError *error);

/** @} */

#ifdef __cplusplus
}
#endif
#endif
