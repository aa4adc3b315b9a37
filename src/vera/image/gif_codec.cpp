// SPDX-License-Identifier: Apache-2.0
#include "vera/base/check.h"
#include "vera/base/output_file.h"
#include "vera/image/indexed_file.h"

#include <exception>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gif_lib.h>

namespace vera {

namespace {

constexpr std::size_t largest_side = 65535;

/// What giflib's callback works on: exceptions must not pass through giflib.
struct Target {
    OutputFile& file;
    std::exception_ptr failure;
};

int write_bytes(GifFileType* gif, const GifByteType* data, int size) {
    auto* target = static_cast<Target*>(gif->UserData);
    try {
        target->file.write(std::as_bytes(std::span(data, static_cast<std::size_t>(size))));
    } catch (...) {
        target->failure = std::current_exception();
        return 0;
    }
    return size;
}

struct FreeColors {
    void operator()(ColorMapObject* map) const { GifFreeMapObject(map); }
};

using ColorMap = std::unique_ptr<ColorMapObject, FreeColors>;

/// GIF counts colours in powers of two: what is too many is black.
ColorMap color_map(const Palette& palette) {
    int count = 2;
    while (count < static_cast<int>(palette.size()))
        count *= 2;
    std::vector<GifColorType> colors(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < palette.size(); ++i)
        colors[i] = {palette[i][0], palette[i][1], palette[i][2]};
    ColorMap map(GifMakeMapObject(count, colors.data()));
    if (!map)
        throw std::bad_alloc();
    return map;
}

class GifWriter {
public:
    explicit GifWriter(OutputFile& file)
        : target_{file, nullptr} {
        int error = 0;
        gif_ = EGifOpen(&target_, write_bytes, &error);
        if (gif_ == nullptr)
            throw std::bad_alloc();
        EGifSetGifVersion(gif_, true);
    }

    ~GifWriter() {
        if (gif_ != nullptr)
            EGifCloseFile(gif_, nullptr);
    }

    GifWriter(const GifWriter&) = delete;
    GifWriter& operator=(const GifWriter&) = delete;

    void begin(const IndexedPicture& picture, bool moving) {
        const ColorMap colors = color_map(picture.palette);
        constexpr int bits = 8;
        check(EGifPutScreenDesc(
            gif_,
            static_cast<int>(picture.width),
            static_cast<int>(picture.height),
            bits,
            0,
            colors.get()));
        if (moving)
            put_loop();
    }

    void put_frame(const IndexedPicture& picture, bool moving, unsigned delay_hundredths) {
        if (moving) {
            const GraphicsControlBlock control = {
                DISPOSE_DO_NOT, false, static_cast<int>(delay_hundredths), NO_TRANSPARENT_COLOR};
            std::array<GifByteType, 4> bytes = {};
            EGifGCBToExtension(&control, bytes.data());
            check(EGifPutExtension(gif_, GRAPHICS_EXT_FUNC_CODE, bytes.size(), bytes.data()));
        }
        check(EGifPutImageDesc(
            gif_,
            0,
            0,
            static_cast<int>(picture.width),
            static_cast<int>(picture.height),
            false,
            nullptr));
        std::vector<std::uint8_t> row(picture.width);
        for (std::size_t y = 0; y < picture.height; ++y) {
            picture.next_row(row);
            check(EGifPutLine(gif_, row.data(), static_cast<int>(row.size())));
        }
    }

    void end() { check(EGifCloseFile(std::exchange(gif_, nullptr), nullptr)); }

private:
    /// "NETSCAPE2.0" with 0: again and again.
    void put_loop() {
        constexpr std::string_view name = "NETSCAPE2.0";
        const std::array<GifByteType, 3> forever = {1, 0, 0};
        check(EGifPutExtensionLeader(gif_, APPLICATION_EXT_FUNC_CODE));
        check(EGifPutExtensionBlock(gif_, static_cast<int>(name.size()), name.data()));
        check(EGifPutExtensionBlock(gif_, static_cast<int>(forever.size()), forever.data()));
        check(EGifPutExtensionTrailer(gif_));
    }

    void check(int result) const {
        if (target_.failure)
            std::rethrow_exception(target_.failure);
        if (result == GIF_OK)
            return;
        const char* const reason = gif_ == nullptr ? nullptr : GifErrorString(gif_->Error);
        throw std::runtime_error(
            "cannot write " + target_.file.name()
            + ": giflib: " + (reason == nullptr ? "unknown error" : reason));
    }

    Target target_;
    GifFileType* gif_ = nullptr;
};

} // namespace

void write_gif(
    std::span<const IndexedPicture> pictures, OutputFile& file, unsigned delay_hundredths) {
    VERA_CHECK(!pictures.empty());
    const IndexedPicture& first = pictures.front();
    if (first.width > largest_side || first.height > largest_side)
        throw std::runtime_error(
            "cannot write " + file.name()
            + ": a GIF picture has at most 65535 pixels a side; choose PNG");
    const bool moving = pictures.size() > 1;
    GifWriter writer(file);
    writer.begin(first, moving);
    for (const IndexedPicture& picture : pictures) {
        VERA_CHECK(picture.width == first.width && picture.height == first.height);
        VERA_CHECK(picture.palette == first.palette);
        writer.put_frame(picture, moving, delay_hundredths);
    }
    writer.end();
}

} // namespace vera
