// SPDX-License-Identifier: Apache-2.0
// The compressed raster beside libpng: size, and how fast pictures are read.
//
// raster_bench PICTURE ...    of 8 bits
//
// Size is that of PNG at level 9, the smaller one of libpng's choice among all filters and of that
// among two, as VERA writes it. Reading is from memory to memory that is there already, with all
// checksums, in turn in one thread; medians of processor time over 21 turns. Prints a JSON array.

#include "vera/base/output_file.h"
#include "vera/base/parallel.h"
#include "vera/image/compressed_raster.h"
#include "vera/image/image_file.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <png.h>
#include <unistd.h>

namespace {

using namespace vera;

using Bytes = std::vector<unsigned char>;

double cpu_seconds() {
    timespec time = {};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

const std::vector<std::uint8_t>& samples_of(const Image& image) {
    return std::get<std::vector<std::uint8_t>>(image.samples);
}

Bytes as_png(const Image& image, int filters) {
    Bytes bytes;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(
        png,
        &bytes,
        [](png_structp writer, png_bytep data, std::size_t size) {
            auto* to = static_cast<Bytes*>(png_get_io_ptr(writer));
            to->insert(to->end(), data, data + size);
        },
        nullptr);
    png_set_compression_level(png, 9);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, filters);
    png_set_IHDR(
        png,
        info,
        static_cast<png_uint_32>(image.width),
        static_cast<png_uint_32>(image.height),
        8,
        PNG_COLOR_TYPE_RGB,
        PNG_INTERLACE_NONE,
        PNG_COMPRESSION_TYPE_DEFAULT,
        PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    for (std::size_t y = 0; y < image.height; ++y)
        png_write_row(png, samples_of(image).data() + 3 * image.width * y);
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    return bytes;
}

void read_png(const Bytes& bytes, std::size_t row_bytes, std::uint8_t* samples) {
    const unsigned char* unread = bytes.data();
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_read_fn(png, &unread, [](png_structp reader, png_bytep data, std::size_t size) {
        auto* from = static_cast<const unsigned char**>(png_get_io_ptr(reader));
        std::memcpy(data, *from, size);
        *from += size;
    });
    png_read_info(png, info);
    const std::size_t height = png_get_image_height(png, info);
    for (std::size_t y = 0; y < height; ++y)
        png_read_row(png, samples + y * row_bytes, nullptr);
    png_read_end(png, nullptr);
    png_destroy_read_struct(&png, &info, nullptr);
}

std::vector<std::byte> as_raster(const Image& image, unsigned error) {
    std::string name = (std::filesystem::temp_directory_path() / "vera-bench-XXXXXX").string();
    close(mkstemp(name.data()));
    write_image(image, name, ImageFileFormat::vra8, {}, {.raster_error = error});
    std::ifstream file(name, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    std::filesystem::remove(name);
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

void measure(const char* path, bool first) {
    const Image image = read_image(path);
    if (sample_type(image) != SampleType::integer8) {
        fmt::print(stderr, "raster_bench: {} is no picture of 8 bits\n", path);
        std::exit(1);
    }
    const Bytes all_filters = as_png(image, PNG_ALL_FILTERS);
    const Bytes two_filters = as_png(image, PNG_FILTER_SUB | PNG_FILTER_UP);
    const Bytes& png = all_filters.size() <= two_filters.size() ? all_filters : two_filters;
    const std::vector<std::byte> raster = as_raster(image, 0);

    constexpr int turns = 21;
    std::vector<std::uint8_t> from_png(samples_of(image).size());
    Image from_raster = blank_image(image.width, image.height, SampleType::integer8);
    std::vector<double> png_seconds;
    std::vector<double> raster_seconds;
    for (int turn = 0; turn < turns; ++turn) {
        double start = cpu_seconds();
        read_png(png, 3 * image.width, from_png.data());
        png_seconds.push_back(cpu_seconds() - start);
        start = cpu_seconds();
        const CompressedRaster file(raster, "raster");
        file.read_part({0, 0, image.width, image.height}, from_raster);
        raster_seconds.push_back(cpu_seconds() - start);
        if (from_raster.samples != image.samples || from_png != samples_of(image)) {
            fmt::print(stderr, "raster_bench: {} is not what it was\n", path);
            std::exit(1);
        }
    }
    fmt::print(
        "{}{{\"picture\": \"{}\", \"png_bytes\": {}, \"vra_bytes\": {}, \"vra_error_1_bytes\": {}, "
        "\"vra_error_2_bytes\": {}, \"vra_error_8_bytes\": {}, \"png_seconds\": {:.6f}, "
        "\"vra_seconds\": {:.6f}}}",
        first ? "[" : ",\n",
        std::filesystem::path(path).stem().string(),
        png.size(),
        raster.size(),
        as_raster(image, 1).size(),
        as_raster(image, 2).size(),
        as_raster(image, 8).size(),
        median(png_seconds),
        median(raster_seconds));
}

} // namespace

int main(int count, char** names) {
    const ThreadLimit limit(1);
    if (count < 2) {
        fmt::print(stderr, "usage: raster_bench PICTURE ...\n");
        return 2;
    }
    for (int i = 1; i < count; ++i)
        measure(names[i], i == 1);
    fmt::print("]\n");
    return 0;
}
