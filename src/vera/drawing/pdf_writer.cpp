// SPDX-License-Identifier: Apache-2.0
#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"
#include "vera/base/random.h"
#include "vera/drawing/document_text.h"
#include "vera/drawing/page_content.h"
#include "vera/drawing/pdf_layers.h"
#include "vera/drawing/xmp_packet.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <zlib.h>

namespace vera {

namespace {

using namespace detail;

/// A stream of zlib that ends with its scope.
class Deflation {
public:
    Deflation() {
        if (deflateInit(&stream_, Z_DEFAULT_COMPRESSION) != Z_OK)
            throw std::runtime_error("the memory does not suffice to compress a drawing");
    }

    ~Deflation() { deflateEnd(&stream_); }

    Deflation(const Deflation&) = delete;
    Deflation& operator=(const Deflation&) = delete;

    /// Appends what the bytes, the last ones or not, give.
    void add(std::string_view bytes, bool is_last, std::string& packed) {
        std::array<char, 1U << 15U> room;
        // zlib's way to name what it only reads.
        stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data())); // NOLINT
        stream_.avail_in = static_cast<uInt>(bytes.size());
        do {
            stream_.next_out = reinterpret_cast<Bytef*>(room.data());
            stream_.avail_out = static_cast<uInt>(room.size());
            deflate(&stream_, is_last ? Z_FINISH : Z_NO_FLUSH);
            packed.append(room.data(), room.size() - stream_.avail_out);
        } while (stream_.avail_out == 0);
    }

private:
    z_stream stream_ = {};
};

std::string deflated(
    std::string_view bytes, const Progress& progress = {}, const CancelFlag* cancel = nullptr) {
    constexpr std::size_t part = 1U << 18U;
    const std::size_t parts = std::max<std::size_t>((bytes.size() + part - 1) / part, 1);
    std::string packed;
    Deflation deflation;
    const LongLoop loop(parts, progress, cancel, 1);
    for (std::size_t i = 0; i < parts; ++i) {
        loop.turn(i);
        deflation.add(bytes.substr(i * part, part), i + 1 == parts, packed);
    }
    return packed;
}

/// 128 bits of the bytes, in hexadecimal: the same for the same document, and hardly for another.
std::string digest(std::string_view bytes) {
    std::uint64_t first = 1;
    std::uint64_t second = 2;
    for (const char byte : bytes) {
        first = (first ^ static_cast<unsigned char>(byte)) * 0x100000001b3U; // FNV-1a
        second = scrambled_bits(second ^ first);
    }
    return fmt::format("{:016X}{:016X}", scrambled_bits(first), second);
}

std::string stream_object(
    const std::string& entries,
    const std::string& bytes,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr) {
    const std::string packed = deflated(bytes, progress, cancel);
    return fmt::format(
        "<<{}/Length {}/Filter/FlateDecode>>\nstream\n{}\nendstream",
        entries,
        packed.size(),
        packed);
}

/// Objects one after the other, numbered from 1, and the table of where they are.
class PdfObjects {
public:
    explicit PdfObjects(std::string& bytes)
        : bytes_(bytes)
        , start_(bytes.size()) {
        // Bytes beyond ASCII tell programs that copy files that this is no text.
        bytes_ += "%PDF-1.7\n%\xE2\xE3\xCF\xD3\n";
    }

    void add(std::string_view object) {
        places_.push_back({bytes_.size() - start_, false});
        bytes_ += fmt::format("{} 0 obj\n{}\nendobj\n", places_.size(), object);
    }

    /// Small objects, which are not streams, packed together as one more object behind them.
    void add_packed(const std::vector<std::string>& objects) {
        std::string offsets;
        std::string text;
        for (std::size_t i = 0; i < objects.size(); ++i) {
            places_.push_back({i, true});
            offsets += fmt::format("{} {} ", places_.size(), text.size());
            text += objects[i] + "\n";
        }
        packed_in_ = places_.size() + 1;
        add(stream_object(
            fmt::format("/Type/ObjStm/N {}/First {}", objects.size(), offsets.size()),
            offsets + text));
    }

    void finish(std::size_t catalog, std::size_t information) {
        const std::string id = digest(std::string_view(bytes_).substr(start_));
        const std::size_t table = bytes_.size() - start_;
        const std::string ends =
            fmt::format("/Root {} 0 R/Info {} 0 R/ID[<{}><{}>]", catalog, information, id, id);
        if (packed_in_ > 0)
            write_table_stream(ends);
        else
            write_table(ends);
        bytes_ += fmt::format("startxref\n{}\n%%EOF\n", table);
    }

private:
    struct Place {
        std::size_t at = 0; ///< in the file, or the object's number among those packed together
        bool is_packed = false;
    };

    void write_table(const std::string& ends) {
        bytes_ += fmt::format("xref\n0 {}\n0000000000 65535 f \n", places_.size() + 1);
        for (const Place& place : places_)
            bytes_ += fmt::format("{:010} 00000 n \n", place.at);
        bytes_ += fmt::format("trailer\n<</Size {}{}>>\n", places_.size() + 1, ends);
    }

    /// The table as a stream, which alone can tell of packed objects: an entry is its kind in a
    /// byte, and two numbers of 5 bytes.
    void write_table_stream(const std::string& ends) {
        std::string table;
        const auto add_number = [&](std::size_t number, int bytes) {
            for (int i = bytes - 1; i >= 0; --i)
                table += static_cast<char>(number >> (8 * i) & 0xffU);
        };
        const auto add_entry = [&](std::size_t kind, std::size_t first, std::size_t second) {
            add_number(kind, 1);
            add_number(first, 5);
            add_number(second, 5);
        };
        add_entry(0, 0, 65535);
        const std::size_t own = bytes_.size() - start_;
        for (const Place& place : places_)
            place.is_packed ? add_entry(2, packed_in_, place.at) : add_entry(1, place.at, 0);
        add_entry(1, own, 0);
        const std::size_t count = places_.size() + 2;
        add(stream_object(fmt::format("/Type/XRef/Size {}/W[1 5 5]{}", count, ends), table));
    }

    std::string& bytes_;
    std::size_t start_;
    std::vector<Place> places_;
    std::size_t packed_in_ = 0; ///< the object that holds the packed ones; 0: there are none
};

std::string information_object(const Drawing& drawing) {
    std::string texts = "/Producer(VERA)";
    if (!drawing.title.empty())
        texts += "/Title" + pdf_string(drawing.title);
    if (!drawing.description.empty())
        texts += "/Subject" + pdf_string(drawing.description);
    return "<<" + texts + ">>";
}

/// Not packed, so that programs that do not read PDF find it as well.
std::string metadata_object(const Drawing& drawing) {
    const std::string packet = xmp_packet(drawing.title, drawing.description);
    return fmt::format(
        "<</Type/Metadata/Subtype/XML/Length {}>>\nstream\n{}\nendstream", packet.size(), packet);
}

/// "/P0 10 0 R/P1 11 0 R", by which a page calls the patterns of gradients.
std::string pattern_resources(const Gradients& gradients, std::size_t first_pattern) {
    std::string patterns;
    for (std::size_t i = 0; i < gradients.count(); ++i)
        patterns += fmt::format("/P{} {} 0 R", i, first_pattern + i);
    return patterns.empty() ? patterns : "/Pattern<<" + patterns + ">>";
}

} // namespace

void write_pdf(
    const Drawing& drawing,
    const DrawingSettings& settings,
    std::string& bytes,
    const Progress& progress,
    const CancelFlag* cancel) {
    enum : std::size_t { catalog = 1, pages, page, content, information, first_layer };

    StageProgress stages(progress, 4);
    const Lattice lattice(settings.precision);
    const Layers drawn =
        layers(drawing, settings, lattice, LaterOutlines::at_once, stages.next(1), cancel);
    const Gradients gradients(drawn.fills);
    const PageSize size = page_size(drawing, settings);
    PdfLayers optional = {layer_names(drawn), {}, first_layer};
    const std::size_t metadata = first_layer + optional.names.size();
    const std::size_t first_packed = metadata + 1; // the patterns, then the groups
    optional.first_group = first_packed + gradients.count();

    const PageMarks marks = {
        [](std::size_t layer, const std::string&) { return fmt::format("/OC /L{} BDC\n", layer); },
        "EMC\n",
        [&](const std::string& name, std::size_t depth) {
            optional.groups.push_back({name, depth});
            return fmt::format("/OC /G{} BDC\n", optional.groups.size() - 1);
        },
        "EMC\n"};
    const std::string text =
        page_content(drawing, settings, lattice, drawn, gradients, marks, stages.next(1), cancel);

    std::vector<std::string> packed;
    for (std::size_t i = 0; i < gradients.count(); ++i)
        packed.push_back(fmt::format(
            "<<{}/Matrix{}>>",
            shading_pattern(gradients[i]),
            pattern_matrix(gradients[i], size, drawing.width)));
    for (const PdfLayers::Group& group : optional.groups)
        packed.push_back(pdf_layer(group.name));
    std::string properties = optional.properties();
    std::string content_properties = optional.content_properties();
    if (!optional.groups.empty()) { // lists of them are long
        packed.push_back(std::move(properties));
        properties = fmt::format(" {} 0 R", first_packed + packed.size() - 1);
        packed.push_back(std::move(content_properties));
        content_properties = fmt::format(" {} 0 R", first_packed + packed.size() - 1);
    }

    PdfObjects objects(bytes);
    objects.add(fmt::format(
        "<</Type/Catalog/Pages {} 0 R/Metadata {} 0 R{}{}>>",
        +pages,
        metadata,
        content_properties.empty() ? "" : "/OCProperties",
        content_properties));
    objects.add(fmt::format("<</Type/Pages/Kids[{} 0 R]/Count 1>>", +page));
    objects.add(fmt::format(
        "<</Type/Page/Parent {} 0 R/MediaBox[0 0 {} {}]/Resources<</Properties{}{}>>"
        "/Contents {} 0 R>>",
        +pages,
        decimal(size.width, 4),
        decimal(size.height, 4),
        properties,
        pattern_resources(gradients, first_packed),
        +content));
    objects.add(stream_object("", text, stages.next(2), cancel));
    objects.add(information_object(drawing));
    for (const std::string& name : optional.names)
        objects.add(pdf_layer(name));
    objects.add(metadata_object(drawing));
    if (!packed.empty())
        objects.add_packed(packed);
    objects.finish(catalog, information);
}

} // namespace vera
