#include "bake/report/Png.h"

#include <png.h>

#include <stdexcept>

namespace tss::reporting {

std::string pngOf(const std::vector<std::uint8_t>& pixels, std::uint32_t width, std::uint32_t height,
                  const std::vector<std::array<std::uint8_t, 3>>& palette) {
    if (pixels.size() != std::size_t(width) * height || pixels.empty() || palette.size() > 256)
        throw std::logic_error("a picture needs its pixels and a palette of at most 256 colours");
    std::vector<std::uint8_t> colours;
    for (std::size_t k = 0; k < palette.size(); ++k) {
        colours.insert(colours.end(), palette[k].begin(), palette[k].end());
        colours.push_back(k == 0 ? 0 : 255);
    }
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = width;
    image.height = height;
    image.format = PNG_FORMAT_RGBA_COLORMAP;
    image.colormap_entries = static_cast<png_uint_32>(palette.size());
    std::string out;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    out.resize(size);
    if (png_image_write_to_memory(&image, out.data(), &size, 0, pixels.data(), 0, colours.data()) == 0)
        throw std::logic_error(std::string("a picture cannot be written: ") + image.message);
    out.resize(size);
    return out;
}

} // namespace tss::reporting
