/** @file
 * Vesper on a Vulkan device of its host, with images of the host.
 *
 * The host makes the device with the features of vesper_device_features and, where it has them, the extensions of
 * vesper_device_extensions, and passes it to vesper_device_borrow. Vesper calls the Vulkan loader of the process
 * (libvulkan.so.1); the host may link or load it.
 *
 * Ownership. The host owns the borrowed objects. It keeps images and semaphores alive until the work that uses them is
 * done, and the device until the VesperDevice is closed.
 *
 * Queue. Vesper uses the queue inside of vesper_tone_map*, vesper_render* and vesper_renderer_create only, between
 * lock_queue and unlock_queue. It never waits for the queue to be idle. Uploads of a scene go through the queue, after
 * earlier submissions. A call that fails submits nothing: it waits for no semaphore and signals none.
 *
 * Order. Vesper's work begins after all earlier submissions to the queue, and later submissions begin after it, memory
 * and layouts included. Semaphores are needed only for other queues and for presentation.
 *
 * Images of the host are 2D; their first layer and level is used. They belong to the queue's family or are shared
 * (VK_SHARING_MODE_CONCURRENT).
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

/** @name Devices of the host
 * @{ */

/** Names of the device extensions that are used where the device has them, valid for ever. None is required: leave out
 * those that the device lacks. The instance must be made for Vulkan 1.3. */
const char* const* vesper_device_extensions(uint32_t* count);
/** Sets the required features and leaves other features unchanged. The chain of `features` must hold the structures of
 * Vulkan 1.2 and 1.3, or those of the extensions that they include. Fails if the device lacks a feature, and names all
 * missing ones. */
VesperResult vesper_device_features(VkPhysicalDevice physical_device, VkPhysicalDeviceFeatures2* features,
                                    VesperError* error);

/** A device that the host made. */
typedef struct VesperHostDevice {
    uint32_t size;                          /**< of this structure */
    uint32_t api_version;                   /**< of the instance (VkApplicationInfo::apiVersion) */
    VkInstance instance;                    /**< of the device */
    VkPhysicalDevice physical_device;       /**< of the device */
    VkDevice device;                        /**< the borrowed device */
    const VkDeviceCreateInfo* created_with; /**< argument of vkCreateDevice; read during the call only */
    VkQueue queue;                          /**< queue for graphics and compute */
    uint32_t queue_family;                  /**< of the queue */
    void (*lock_queue)(void* user);         /**< called before each use of the queue; may be null */
    void (*unlock_queue)(void* user);       /**< called after each use; null if lock_queue is */
    void* user;                             /**< passed to both */
} VesperHostDevice;

/** Borrows a device. Fails if the device lacks a required feature, and names all missing ones. */
VesperResult vesper_device_borrow(const VesperHostDevice* host, VesperDevice** device, VesperError* error);

/** @} */

/** @name Images of the host
 * @{ */

/** An image, and its layouts around a call. */
typedef struct VesperImage {
    uint32_t size;               /**< of this structure */
    VkImage image;               /**< usage: of a picture VK_IMAGE_USAGE_SAMPLED_BIT, of a shown image _TRANSFER_DST_BIT
                                  * */
    VkFormat format;             /**< of a picture: rgba32f, rgba16f, b10g11r11 or e5b9g9r9; of a shown image: RGBA or
                                  * BGRA of 8 bits (UNORM or SRGB) or 10 bits. Codes are copied unchanged, with the bits
                                  * of the format */
    uint32_t width;              /**< px */
    uint32_t height;             /**< px */
    VkImageLayout layout_before; /**< when the work begins; of a shown image VK_IMAGE_LAYOUT_UNDEFINED is allowed */
    VkImageLayout layout_after;  /**< when the work is done; of a swapchain image VK_IMAGE_LAYOUT_PRESENT_SRC_KHR */
    uint32_t reserved;           /**< 0 */
} VesperImage;

/** Semaphores around the work of a call, for other queues. Both lists may be empty. */
typedef struct VesperHandover {
    uint32_t size;                        /**< of this structure */
    uint32_t wait_count;                  /**< of `waits` */
    uint32_t signal_count;                /**< of `signals` */
    const VkSemaphoreSubmitInfo* waits;   /**< binary or timeline; waited for before the work */
    const VkSemaphoreSubmitInfo* signals; /**< signalled after the work */
} VesperHandover;

/** A picture in an image. */
typedef struct VesperImagePicture {
    uint32_t size;            /**< of this structure */
    const VesperImage* image; /**< linear Rec. 709 */
    float scale;              /**< cd/m^2 of a value of 1 */
    float vertical_fov;       /**< angle of the picture's height, rad; used if all `edges` are 0 */
    float edges[4];           /**< as VesperPicture::edges */
} VesperImagePicture;

/** As vesper_tone_map, from an image to an image of the same extent. Submits the work and returns. At most three
 * pictures are in flight. Waits for the picture before if sizes or settings have changed, and with
 * VESPER_GLARE_TEMPORAL and _SPENCER. `handover` may be null. */
VesperResult vesper_tone_map_image(VesperToneMapper* mapper, const VesperToneSettings* settings,
                                   const VesperImagePicture* picture, float seconds, const VesperImage* shown,
                                   const VesperHandover* handover, VesperError* error);
/** As vesper_render, into an image of the view's extent. Submits and waits as vesper_tone_map_image. */
VesperResult vesper_render_image(VesperRenderer* renderer, const VesperToneSettings* settings, const VesperView* view,
                                 float seconds, const VesperImage* shown, const VesperHandover* handover,
                                 VesperError* error);

/** @} */

#ifdef __cplusplus
}
#endif
#endif
