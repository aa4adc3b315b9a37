// SPDX-License-Identifier: Apache-2.0
// How far pictures of few colours are from the one that they were made of, as an eye sees it that
// does not tell single pixels: the mean distance in Oklab, times 100, after both were blurred in
// linear light by a Gaussian of 1.5 pixels.
//
// colors_bench ORIGINAL PICTURE ...    prints a number a line

#include "vera/image/converted_image.h"
#include "vera/image/image_file.h"
#include "vera/image/oklab.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include <fmt/format.h>

namespace {

using namespace vera;

constexpr double sigma = 1.5;
constexpr std::ptrdiff_t reach = 5;

std::array<double, 2 * reach + 1> gaussian() {
    std::array<double, 2 * reach + 1> weights = {};
    for (std::ptrdiff_t k = -reach; k <= reach; ++k)
        weights[static_cast<std::size_t>(k + reach)] =
            std::exp(-static_cast<double>(k * k) / (2 * sigma * sigma));
    return weights;
}

/// Along rows where step is 3, along columns where it is a row; what lies outside repeats the edge.
std::vector<float> blurred(
    const std::vector<float>& samples, std::size_t length, std::size_t step, std::size_t width) {
    const auto gaussian_weights = gaussian();
    std::vector<float> result(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const auto place = static_cast<std::ptrdiff_t>(step == 3 ? i / 3 % width : i / (3 * width));
        double sum = 0;
        double weights = 0;
        for (std::ptrdiff_t k = -reach; k <= reach; ++k) {
            const std::ptrdiff_t at = place + k;
            if (at < 0 || at >= static_cast<std::ptrdiff_t>(length))
                continue;
            const double weight = gaussian_weights[static_cast<std::size_t>(k + reach)];
            sum += weight * static_cast<double>(samples[i + static_cast<std::size_t>(k) * step]);
            weights += weight;
        }
        result[i] = static_cast<float>(sum / weights);
    }
    return result;
}

std::vector<float> seen(const char* path) {
    const Image image = converted_image(read_image(path), SampleType::float32);
    const auto& samples = std::get<std::vector<float>>(image.samples);
    return blurred(
        blurred(samples, image.width, 3, image.width), image.height, 3 * image.width, image.width);
}

} // namespace

int main(int count, char** names) {
    if (count < 3) {
        fmt::print(stderr, "usage: colors_bench ORIGINAL PICTURE ...\n");
        return 2;
    }
    const std::vector<float> original = seen(names[1]);
    const auto color = [](const std::vector<float>& samples, std::size_t i) {
        const auto light = [&](std::size_t c) { return static_cast<double>(samples[i + c]); };
        return oklab(LinearRgb{light(0), light(1), light(2)});
    };
    for (int k = 2; k < count; ++k) {
        const std::vector<float> picture = seen(names[k]);
        if (picture.size() != original.size())
            return 1;
        double sum = 0;
        for (std::size_t i = 0; i < original.size(); i += 3)
            sum += std::sqrt(squared_distance(color(original, i), color(picture, i)));
        const std::size_t pixels = original.size() / 3;
        fmt::print("{:.3f}\n", 100 * sum / static_cast<double>(pixels));
    }
    return 0;
}
