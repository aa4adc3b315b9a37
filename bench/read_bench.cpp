// SPDX-License-Identifier: Apache-2.0
// How fast the readers are, and how much memory they take.
//
// read_bench [MEGABYTES]    of each format that much text; 50
// read_bench FILE ...       files, by their extension
//
// The measure is a bare loop of std::from_chars over the same bytes, run in turn with the reader;
// times are processor time, medians of five. Memory is what the peak of a process that does nothing
// but read grows by, the mapped file included, by the size of the file. The last inputs have the
// shortest words that there can be: docs/platforms.md says what they take.

#include "vera/formats/read_scene.h"
#include "vera/formats/source_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

namespace {

using namespace vera;

double cpu_seconds() {
    timespec time = {};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Every number of the text, read as a double: their sum. White space is passed over without asking
/// std::from_chars, which makes the loop as fast as it gets.
double bare_loop(std::string_view text) {
    const char* at = text.data();
    const char* const end = at + text.size();
    double sum = 0;
    while (at != end) {
        if (*at == ' ' || *at == '\n') {
            ++at;
            continue;
        }
        double value = 0;
        const auto [rest, error] = std::from_chars(at, end, value);
        if (error == std::errc::invalid_argument) {
            ++at;
        } else {
            sum += value;
            at = rest;
        }
    }
    return sum;
}

void read_file(const std::filesystem::path& path) {
    if (read_scene(path).scene.geometry.items.empty())
        std::abort();
}

/// A line of /proc/self/status, in kilobytes.
std::size_t status_kilobytes(std::string_view key) {
    std::ifstream status("/proc/self/status");
    std::string line;
    while (std::getline(status, line))
        if (line.compare(0, key.size(), key) == 0)
            return std::strtoull(line.c_str() + key.size() + 1, nullptr, 10);
    return 0;
}

/// What the peak of a child process grows by while it reads, in bytes.
std::size_t peak_growth(const std::filesystem::path& path) {
    int channel[2];
    if (pipe(channel) != 0)
        std::abort();
    const pid_t child = fork();
    if (child == 0) {
        malloc_trim(0); // what was freed before must not be there to be used again
        std::ofstream("/proc/self/clear_refs") << "5\n"; // forgets the peak so far
        const std::size_t before = status_kilobytes("VmRSS");
        read_file(path);
        const std::size_t after = status_kilobytes("VmHWM");
        const std::size_t growth = after > before ? 1024 * (after - before) : 0;
        const bool written = write(channel[1], &growth, sizeof growth) == sizeof growth;
        _exit(written ? 0 : 1);
    }
    std::size_t growth = 0;
    if (read(channel[0], &growth, sizeof growth) != sizeof growth)
        std::abort();
    close(channel[0]);
    close(channel[1]);
    waitpid(child, nullptr, 0);
    return growth;
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

void measure(const std::string& name, const std::filesystem::path& path) {
    const auto size = static_cast<double>(std::filesystem::file_size(path));
    std::vector<double> bare;
    std::vector<double> ours;
    double sum = 0;
    for (int round = 0; round < 5; ++round) {
        const double start = cpu_seconds();
        {
            const SourceText source(path);
            sum += bare_loop(source.text());
        }
        const double middle = cpu_seconds();
        read_file(path);
        ours.push_back(cpu_seconds() - middle);
        bare.push_back(middle - start);
    }
    std::printf(
        "%-28s %7.1f MB  from_chars %5.0f MB/s  ours %5.0f MB/s  time x %.2f  memory x %.2f%s\n",
        name.c_str(),
        size / 1e6,
        size / 1e6 / median(bare),
        size / 1e6 / median(ours),
        median(ours) / median(bare),
        static_cast<double>(peak_growth(path)) / size,
        std::isfinite(sum) ? "" : " ");
    std::fflush(stdout);
}

/// A rolling surface of side x side corners; put(text, x, y, z) for each.
void for_each_corner(
    std::size_t side, const std::function<void(double x, double y, double z)>& put) {
    for (std::size_t i = 0; i < side; ++i)
        for (std::size_t j = 0; j < side; ++j) {
            const double x = static_cast<double>(i) / 97.0;
            const double y = static_cast<double>(j) / 89.0;
            put(x, y, std::sin(3.1 * x) * std::cos(2.3 * y));
        }
}

/// Two triangles for each square of it, by the numbers of their corners.
void for_each_triangle(
    std::size_t side, const std::function<void(std::size_t a, std::size_t b, std::size_t c)>& put) {
    for (std::size_t i = 0; i + 1 < side; ++i)
        for (std::size_t j = 0; j + 1 < side; ++j) {
            const std::size_t a = i * side + j;
            put(a, a + 1, a + side);
            put(a + 1, a + side + 1, a + side);
        }
}

std::string obj_text(std::size_t side, int digits, bool with_normals) {
    std::string text = "# a rolling surface\n";
    auto out = std::back_inserter(text);
    for_each_corner(side, [&](double x, double y, double z) {
        fmt::format_to(out, "v {:.{}g} {:.{}g} {:.{}g}\n", x, digits, y, digits, z, digits);
        if (with_normals)
            fmt::format_to(out, "vt {:.6f} {:.6f}\nvn {:.6f} {:.6f} {:.6f}\n", x, y, z, y, x);
    });
    for_each_triangle(side, [&](std::size_t a, std::size_t b, std::size_t c) {
        if (with_normals)
            fmt::format_to(out, "f {0}/{0}/{0} {1}/{1}/{1} {2}/{2}/{2}\n", a + 1, b + 1, c + 1);
        else
            fmt::format_to(out, "f {} {} {}\n", a + 1, b + 1, c + 1);
    });
    return text;
}

std::string ply_header(std::size_t side, const char* format) {
    return fmt::format(
        "ply\nformat {} 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
        "property float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        format,
        side * side,
        2 * (side - 1) * (side - 1));
}

std::string ply_text(std::size_t side) {
    std::string text = ply_header(side, "ascii");
    auto out = std::back_inserter(text);
    for_each_corner(side, [&](double x, double y, double z) {
        fmt::format_to(out, "{:.6g} {:.6g} {:.6g}\n", x, y, z);
    });
    for_each_triangle(side, [&](std::size_t a, std::size_t b, std::size_t c) {
        fmt::format_to(out, "3 {} {} {}\n", a, b, c);
    });
    return text;
}

template <typename Value>
void append_bytes(std::string& text, Value value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    text.append(bytes, sizeof value);
}

std::string binary_ply(std::size_t side) {
    std::string text = ply_header(side, "binary_little_endian");
    for_each_corner(side, [&](double x, double y, double z) {
        for (const double value : {x, y, z})
            append_bytes(text, static_cast<float>(value));
    });
    for_each_triangle(side, [&](std::size_t a, std::size_t b, std::size_t c) {
        text += '\3';
        for (const std::size_t corner : {a, b, c})
            append_bytes(text, static_cast<std::int32_t>(corner));
    });
    return text;
}

std::vector<Vec3> corners(std::size_t side) {
    std::vector<Vec3> points;
    for_each_corner(side, [&](double x, double y, double z) { points.push_back({x, y, z}); });
    return points;
}

std::string stl_text(std::size_t side) {
    const std::vector<Vec3> points = corners(side);
    std::string text = "solid surface\n";
    auto out = std::back_inserter(text);
    for_each_triangle(side, [&](std::size_t a, std::size_t b, std::size_t c) {
        text += "facet normal 0.0 0.0 1.0\n  outer loop\n";
        for (const std::size_t i : {a, b, c})
            fmt::format_to(
                out, "    vertex {:.6e} {:.6e} {:.6e}\n", points[i].x, points[i].y, points[i].z);
        text += "  endloop\nendfacet\n";
    });
    return text + "endsolid surface\n";
}

std::string binary_stl(std::size_t side) {
    const std::vector<Vec3> points = corners(side);
    std::string text(80, ' ');
    append_bytes(text, static_cast<std::uint32_t>(2 * (side - 1) * (side - 1)));
    for_each_triangle(side, [&](std::size_t a, std::size_t b, std::size_t c) {
        text.append(12, '\0');
        for (const std::size_t i : {a, b, c})
            for (const double value : {points[i].x, points[i].y, points[i].z})
                append_bytes(text, static_cast<float>(value));
        text.append(2, '\0');
    });
    return text;
}

std::string nff_patches(std::size_t side) {
    const std::vector<Vec3> points = corners(side);
    std::string text = "b 0 0 0\nl 1 2 3\nf 1 .5 .25 .8 .2 20 0 1\n";
    auto out = std::back_inserter(text);
    for_each_triangle(side, [&](std::size_t a, std::size_t b, std::size_t c) {
        text += "pp 3\n";
        for (const std::size_t i : {a, b, c})
            fmt::format_to(
                out,
                "{:.6g} {:.6g} {:.6g} {:.6g} {:.6g} {:.6g}\n",
                points[i].x,
                points[i].y,
                points[i].z,
                points[i].z,
                points[i].y,
                points[i].x);
    });
    return text;
}

std::string nff_spheres(std::size_t side) {
    std::string text = "b 0 0 0\nl 1 2 3\n";
    auto out = std::back_inserter(text);
    for_each_corner(side, [&](double x, double y, double z) {
        fmt::format_to(out, "s {:.6g} {:.6g} {:.6g} 0.01\n", x, y, z);
    });
    return text;
}

/// Triangles, or patches whose normals are the corners.
std::string scene_triangles(std::size_t side, int digits, const char* keyword) {
    const std::vector<Vec3> points = corners(side);
    std::string text = "CM m MA m\n";
    auto out = std::back_inserter(text);
    const int rounds = std::string_view(keyword) == "PA" ? 2 : 1;
    for_each_triangle(side, [&](std::size_t a, std::size_t b, std::size_t c) {
        text += keyword;
        for (int round = 0; round < rounds; ++round)
            for (const std::size_t i : {a, b, c})
                for (const double value : {points[i].x, points[i].y, points[i].z})
                    fmt::format_to(out, " {:.{}g}", value, digits);
        text += '\n';
    });
    return text;
}

std::string scene_quadrangles(std::size_t side) {
    std::string text = "CM m MA m\n";
    auto out = std::back_inserter(text);
    for (std::size_t i = 0; i < side; ++i)
        for (std::size_t j = 0; j < side; ++j)
            fmt::format_to(
                out, "P4 {0} {1} -15  {2} {1} -15  {2} {3} -15  {0} {3} -15\n", i, j, i + 1, j + 1);
    return text;
}

std::string scene_spheres(std::size_t side) {
    std::string text = "CM m MA m\n";
    auto out = std::back_inserter(text);
    for_each_corner(side, [&](double x, double y, double z) {
        fmt::format_to(out, "SP {:.6g} {:.6g} {:.6g} 0.01\n", x, y, z);
    });
    return text;
}

/// The same lines again and again, up to so many bytes.
std::string repeated(std::string_view line, std::size_t bytes) {
    std::string text;
    while (text.size() < bytes)
        text += line;
    return text;
}

std::string smallest_ply(std::size_t bytes) {
    constexpr std::string_view vertex = "1 0 0\n";
    const std::size_t count = bytes / vertex.size();
    return fmt::format(
               "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
               "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
               "end_header\n0 0 0\n0 1 0\n",
               count + 2)
        + repeated(vertex, count * vertex.size()) + "3 0 1 2\n";
}

void measure_generated(double megabytes) {
    struct Input {
        const char* name;
        const char* file;
        std::function<std::string(std::size_t side)> make;
        double bytes_per_corner; ///< of the surface, roughly
    };

    const Input inputs[] = {
        {"P3, 6 digits", "j.vera", [](std::size_t n) { return scene_triangles(n, 6, "P3"); }, 160},
        {"P3, 17 digits",
         "k.vera",
         [](std::size_t n) { return scene_triangles(n, 17, "P3"); },
         360},
        {"PA, 6 digits", "l.vera", [](std::size_t n) { return scene_triangles(n, 6, "PA"); }, 310},
        {"P4, small integers", "m.vera", scene_quadrangles, 48},
        {"SP, 6 digits", "n.vera", scene_spheres, 34},
        {"OBJ, 6 digits", "a.obj", [](std::size_t n) { return obj_text(n, 6, false); }, 72},
        {"OBJ, 17 digits", "b.obj", [](std::size_t n) { return obj_text(n, 17, false); }, 105},
        {"OBJ, vt and vn", "c.obj", [](std::size_t n) { return obj_text(n, 6, true); }, 210},
        {"PLY, ascii", "d.ply", ply_text, 72},
        {"PLY, binary", "e.ply", binary_ply, 38},
        {"STL, ascii", "f.stl", stl_text, 460},
        {"STL, binary", "g.stl", binary_stl, 100},
        {"NFF, patches", "h.nff", nff_patches, 330},
        {"NFF, spheres", "i.nff", nff_spheres, 32}};
    const auto bytes = static_cast<std::size_t>(1e6 * megabytes);

    struct SmallestInput {
        const char* name;
        const char* file;
        std::string text;
    };

    const SmallestInput smallest[] = {
        {"SP, shortest words", "o.vera", "CM m MA m\n" + repeated("SP 0 0 0 1\n", bytes)},
        {"P3, shortest words", "p.vera", "CM m MA m\n" + repeated("P3 0 0 0 1 0 0 0 1 0\n", bytes)},
        {"P4, shortest words",
         "q.vera",
         "CM m MA m\n" + repeated("P4 0 0 0 1 0 0 1 1 0 0 1 0\n", bytes)},
        {"OBJ v, shortest words",
         "r.obj",
         "v 0 1 0\nv 1 0 0\n" + repeated("v 0 0 0\n", bytes) + "f 1 2 3\n"},
        {"OBJ vn, shortest words",
         "s.obj",
         "v 0 1 0\nv 1 0 0\nv 0 0 0\n" + repeated("vn 0 0 1\n", bytes) + "f 1//1 2//1 3//1\n"},
        {"OBJ f, shortest words",
         "t.obj",
         "v 0 1 0\nv 1 0 0\nv 0 0 0\nv 1 1 0\n" + repeated("f 1 2 3\n", bytes)},
        {"OBJ f 4, shortest words",
         "u.obj",
         "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n" + repeated("f 1 2 3 4\n", bytes)},
        {"PLY, shortest words", "v.ply", smallest_ply(bytes)},
        {"STL, shortest words",
         "w.stl",
         "solid\n"
             + repeated(
                 "facet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
                 "endfacet\n",
                 bytes)
             + "endsolid\n"},
        {"NFF s, shortest words", "x.nff", "f 1 1 1 1 0 0 0 0\n" + repeated("s 0 0 0 1\n", bytes)},
        {"NFF p, shortest words",
         "y.nff",
         "f 1 1 1 1 0 0 0 0\n" + repeated("p 3\n0 0 0\n1 0 0\n0 1 0\n", bytes)}};
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / fmt::format("read_bench.{}", getpid());
    std::filesystem::create_directory(folder);
    for (const Input& input : inputs) {
        const auto path = folder / input.file;
        const auto side =
            static_cast<std::size_t>(std::sqrt(1e6 * megabytes / input.bytes_per_corner));
        std::ofstream(path, std::ios::binary) << input.make(side);
        measure(input.name, path);
        std::filesystem::remove(path);
    }
    for (const SmallestInput& input : smallest) {
        const auto path = folder / input.file;
        std::ofstream(path, std::ios::binary) << input.text;
        measure(input.name, path);
        std::filesystem::remove(path);
    }
    std::filesystem::remove(folder);
}

} // namespace

int main(int argument_count, char** arguments) {
    const double megabytes = argument_count == 2 ? std::atof(arguments[1]) : 50;
    if (argument_count <= 2 && megabytes > 0) {
        measure_generated(megabytes);
        return 0;
    }
    for (int i = 1; i < argument_count; ++i)
        measure(std::filesystem::path(arguments[i]).filename().string(), arguments[i]);
    return 0;
}
