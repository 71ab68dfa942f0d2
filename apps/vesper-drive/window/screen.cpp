#include "window/screen.h"

#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace vesper::drive {
namespace {

constexpr const char* kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr float kLetters = 14;  // px, times the scale of the desktop

window::WindowCodes codes_of(const vision::Display& display) {
    if (display.bits == 8) return window::WindowCodes::Sdr8;
    return display.eotf == vision::Eotf::Pq ? window::WindowCodes::Hdr10 : window::WindowCodes::Sdr10;
}

window::Overlay overlay_of(const ImDrawData& data) {
    window::Overlay overlay;
    const glm::vec2 origin(data.DisplayPos.x, data.DisplayPos.y),
        scale(data.FramebufferScale.x, data.FramebufferScale.y);
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        const auto first_vertex = uint32_t(overlay.vertices.size()), first_index = uint32_t(overlay.indices.size());
        for (const ImDrawVert& v : list.VtxBuffer)
            overlay.vertices.push_back({(glm::vec2(v.pos.x, v.pos.y) - origin) * scale, {v.uv.x, v.uv.y}, v.col});
        for (const ImDrawCmd& command : list.CmdBuffer) {
            const auto px = [&](float x, float y) { return glm::ivec2((glm::vec2(x, y) - origin) * scale); };
            const glm::ivec2 low = glm::max(px(command.ClipRect.x, command.ClipRect.y), 0),
                             high = px(command.ClipRect.z, command.ClipRect.w);
            if (high.x > low.x && high.y > low.y)
                overlay.batches.push_back({first_index + command.IdxOffset,
                                           command.ElemCount,
                                           {{low.x, low.y}, {uint32_t(high.x - low.x), uint32_t(high.y - low.y)}}});
            for (uint32_t k = 0; k < command.ElemCount; ++k) {
                const uint32_t at = first_index + command.IdxOffset + k;
                if (overlay.indices.size() <= at) overlay.indices.resize(at + 1);
                overlay.indices[at] = first_vertex + command.VtxOffset + list.IdxBuffer[int(command.IdxOffset + k)];
            }
        }
    }
    return overlay;
}

}  // namespace

struct Screen::Instruments {
    explicit Instruments(GLFWwindow* window) {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;  // nothing is left behind
        io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
        ImGui::StyleColorsDark();
        ImGui::GetStyle().WindowRounding = 3;
        ImGui::GetStyle().Colors[ImGuiCol_WindowBg].w = 0.82f;
        float scale = 1;
        glfwGetWindowContentScale(window, &scale, nullptr);
        ImGui::GetStyle().ScaleAllSizes(scale);
        // Without the font, Dear ImGui's own.
        if (std::filesystem::exists(kFont)) io.Fonts->AddFontFromFileTTF(kFont, std::round(kLetters * scale));
        ImGui_ImplGlfw_InitForOther(window, true);
    }
    ~Instruments() {
        ImGui_ImplGlfw_Shutdown();
        ImGui::DestroyContext();
    }
    Instruments(const Instruments&) = delete;
    Instruments& operator=(const Instruments&) = delete;

    struct Letters {
        VkExtent2D extent;
        std::span<const uint8_t> coverage;
    };
    /// Drawn once; a byte a texel.
    static Letters letters() {
        ImGuiIO& io = ImGui::GetIO();
        unsigned char* pixels = nullptr;
        int width = 0, height = 0;
        io.Fonts->GetTexDataAsAlpha8(&pixels, &width, &height);
        return {{uint32_t(width), uint32_t(height)}, {pixels, size_t(width) * size_t(height)}};
    }
};

Screen::Screen(Window& window, gpu::Device& device)
    : window_(window),
      instruments_(std::make_unique<Instruments>(window.handle())),
      swapchain_(device, [&window](VkInstance instance) { return window.make_surface(instance); }),
      image_(device),
      presenter_(device, Instruments::letters().extent, Instruments::letters().coverage) {}

Screen::~Screen() = default;

window::Vsync vsync_of(const std::string& name) {
    return name == "latest" ? window::Vsync::Latest : name == "off" ? window::Vsync::Off : window::Vsync::Wait;
}

bool Screen::shows(const vision::Display& display) const { return swapchain_.offers(codes_of(display)); }

void Screen::begin_instruments(bool keyboard) {
    ImGuiIO& io = ImGui::GetIO();
    if (keyboard)
        io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
    else
        io.ConfigFlags &= ~ImGuiConfigFlags_NavEnableKeyboard;
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

bool Screen::show(const window::Picture& picture, const vision::Display& display, const ScreenSettings& settings) {
    ImGui::Render();
    const window::Overlay overlay = overlay_of(*ImGui::GetDrawData());
    const window::SwapchainSettings how{.extent = window_.extent(),
                                        .vsync = settings.vsync,
                                        .codes = codes_of(display),
                                        .peak = display.peak,
                                        .black = display.black};
    return swapchain_.show(how, [&](VkCommandBuffer commands, const window::WindowImage& image) {
        presenter_.draw(commands, image, picture, settings.scaling, overlay);
    });
}

bool Screen::is_typing() const { return ImGui::GetIO().WantTextInput; }

std::optional<glm::uvec2> Screen::pixel_under_mouse(VkExtent2D picture, window::Scaling scaling) const {
    const VkExtent2D window = window_.extent();
    if (ImGui::GetIO().WantCaptureMouse || window.width == 0 || window.height == 0) return std::nullopt;
    const VkRect2D area = window::place(picture, window, scaling).area;
    const glm::dvec2 at = (window_.mouse() - glm::dvec2(area.offset.x, area.offset.y)) *
                          glm::dvec2(picture.width, picture.height) / glm::dvec2(area.extent.width, area.extent.height);
    if (at.x < 0 || at.y < 0 || at.x >= picture.width || at.y >= picture.height) return std::nullopt;
    return glm::uvec2(at);
}

}  // namespace vesper::drive
