// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/vera_scene.h"

#include "vera/formats/control_words.h"
#include "vera/formats/included_files.h"
#include "vera/formats/made_parts.h"
#include "vera/formats/scene_builder.h"
#include "vera/formats/statement_count.h"
#include "vera/formats/vera_keywords.h"
#include "vera/formats/vera_statements.h"
#include "vera/formats/word_reader.h"
#include "vera/generate/surface.h"

#include <algorithm>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace vera {

namespace {

/// Reads statement after statement, from the text and from those that it includes.
class VeraReader {
public:
    VeraReader(const SourceText& text, const SceneLimits& limits)
        : limits_(limits)
        , builder_(complaints_, limits)
        , files_(complaints_) {
        begin_text(text);
    }

    SceneFile read() {
        while (!complaints_.full() && read_next()) {
        }
        SceneFile file;
        file.scene = builder_.finish();
        // Behind those that items name.
        file.scene.files.insert(
            file.scene.files.end(), files_.mesh_files().begin(), files_.mesh_files().end());
        file.warnings = complaints_.finish();
        number_primitives(file.scene);
        return file;
    }

private:
    WordReader& words() { return *texts_.back(); }

    void begin_text(const SourceText& text) {
        texts_.push_back(std::make_unique<WordReader>(text, complaints_));
        builder_.set_text(text);
        make_room();
    }

    /// Makes room for the rest of the scene or subscene that is being read.
    void make_room() {
        builder_.reserve(count_statements(
            words().rest(), builder_.in_subscene() ? CountFor::subscene : CountFor::main_scene));
    }

    /// False at the end of everything.
    bool read_next() {
        const std::string_view word = words().peek();
        if (word.empty()) {
            if (texts_.size() == 1)
                return false;
            texts_.pop_back();
            builder_.set_text(words().text());
            return true;
        }
        const auto statement = statement_named(word);
        if (!statement) {
            complain_of_word(word);
            words().take();
            skip_statement();
            return true;
        }
        words().take();
        optional_words_ = {};
        const std::size_t errors = complaints_.error_count();
        read_statement(*statement);
        if (complaints_.error_count() > errors)
            skip_statement();
        else
            complete_ = word;
        words().forget_what_was_read();
        return true;
    }

    /// Goes on to the next word that begins a statement, or at the beginning of a line is like one
    /// that does or belongs in a control file: that is another mistake.
    void skip_statement() {
        complete_ = {};
        words().take_until([this](std::string_view word) {
            return statement_named(word)
                || ((is_misspelt_statement(word) || is_control_word(word))
                    && words().at_line_start());
        });
    }

    static bool is_misspelt_statement(std::string_view word) {
        if (statement_named(in_capitals(word)))
            return true;
        // Not a single letter, which is like everything short, and not what goes on with a
        // statement.
        constexpr std::size_t shortest = 3;
        constexpr std::size_t longest = 12;
        if (word.size() < shortest || word.size() > longest || word[0] < 'A' || word[0] > 'Z'
            || std::find(scene_words.begin(), scene_words.end(), word) != scene_words.end())
            return false;
        return !did_you_mean(word, std::span(scene_words.data(), statement_word_count)).empty();
    }

    static std::string in_capitals(std::string_view word) {
        constexpr std::size_t longest = 10;
        std::string capitals(word.substr(0, longest + 1));
        for (char& letter : capitals)
            if (letter >= 'a' && letter <= 'z')
                letter = static_cast<char>(letter - 'a' + 'A');
        return capitals;
    }

    void complain_of_word(std::string_view word) {
        std::vector<std::string_view> candidates(
            scene_words.begin(), scene_words.begin() + statement_word_count);
        candidates.insert(candidates.end(), optional_words_.begin(), optional_words_.end());
        std::string similar;
        std::string remedy;
        if (std::find(scene_words.begin(), scene_words.end(), word) != scene_words.end())
            remedy = fmt::format("{} is a part of other statements", word);
        else if (is_control_word(word))
            remedy = fmt::format("{} belongs in the control file (-c FILE)", word);
        else if (similar = did_you_mean(word, candidates); similar.empty() && !complete_.empty())
            remedy = fmt::format("the {} before it is complete", complete_);
        complaints_.error(
            words().place(),
            fmt::format("expected a statement, found {}{}", shown(word), similar),
            std::move(remedy));
    }

    void read_statement(Statement statement) {
        const WordPlace place = words().last_place();
        switch (statement) {
        case Statement::projection:
        case Statement::parallel:
            return read_camera(statement, place);
        case Statement::light:
            leave_subscene();
            if (const auto light = read_light(words()))
                builder_.add_light(*light);
            return;
        case Statement::material:
            return read_material();
        case Statement::subscene:
            if (const auto name = words().take_name("the name of the subscene", scene_words)) {
                builder_.begin_subscene(*name, words().last_place());
                make_room();
            }
            return;
        case Statement::material_change:
            if (const auto name = words().take_name("the name of a material", scene_words))
                builder_.set_material(*name, words().last_place());
            return;
        case Statement::inner_point:
            if (const auto point = words().take_point("the inner point"))
                builder_.set_inner_point(*point);
            return;
        case Statement::subscene_call:
            return read_call(place);
        case Statement::include:
            return read_include();
        case Statement::mesh:
            return read_mesh_statement(place);
        case Statement::make:
            return read_make(place);
        default:
            return read_primitive(statement, place);
        }
    }

    void read_primitive(Statement statement, const WordPlace& place) {
        switch (statement) {
        case Statement::sphere:
            if (const auto sphere = read_sphere(words()))
                builder_.add(*sphere, place);
            return;
        case Statement::triangle:
            if (const auto triangle = read_triangle(words()))
                builder_.add(*triangle, place);
            return;
        case Statement::quadrangle:
            if (const auto corners = read_quadrangle(words()))
                builder_.add_quadrangle(*corners, place);
            return;
        case Statement::polygon:
            if (const auto corners = read_polygon(words()))
                builder_.add_polygon(*corners, place);
            return;
        case Statement::patch:
            if (const auto patch = read_patch(words()))
                builder_.add(*patch, place);
            return;
        default:
            optional_words_ = contour_words;
            if (auto shapes = read_rotational_shapes(words()))
                for (RotationalShape& shape : *shapes)
                    builder_.add(std::move(shape), place);
            return;
        }
    }

    /// Back to the main scene, which statements that are not geometry belong to.
    void leave_subscene() {
        if (!builder_.in_subscene())
            return;
        builder_.end_subscene();
        make_room();
    }

    void read_camera(Statement statement, const WordPlace& place) {
        leave_subscene();
        const auto camera =
            statement == Statement::parallel ? read_parallel(words()) : read_projection(words());
        if (camera)
            builder_.set_camera(*camera, place);
    }

    void read_material() {
        leave_subscene();
        const auto name = words().take_name("the name of the material", scene_words);
        if (!name)
            return;
        optional_words_ = property_words;
        read_properties(words(), builder_.begin_material(*name, words().last_place()));
    }

    void read_call(const WordPlace& place) {
        const auto name = words().take_name("the name of a subscene", scene_words);
        if (!name)
            return;
        const WordPlace name_place = words().last_place();
        optional_words_ = transformation_words;
        if (const auto placement = read_transformations(words()))
            builder_.add_call(*name, name_place, *placement, place);
    }

    void read_include() {
        const auto name = words().take_file_name();
        if (!name)
            return;
        const WordPlace place = words().last_place();
        const SourceText* const text = files_.text(*name, place);
        if (text == nullptr)
            return;
        constexpr std::size_t most_nested = 100;
        constexpr std::size_t most_inclusions = 10'000;
        for (const auto& reader : texts_)
            if (is_same(reader->text(), *text))
                return complaints_.error(
                    place,
                    fmt::format("{} includes itself{}", shown(*name), inclusion_path(*text)),
                    "take one of the INCLUDE statements out");
        if (texts_.size() > most_nested || ++inclusions_ > most_inclusions)
            return complaints_.error(
                place,
                texts_.size() > most_nested ? "more than 100 files include one another"
                                            : "more than 10000 INCLUDE statements are followed");
        begin_text(*text);
    }

    /// Whether both are of one file. Included files have one text each; the first text may be
    /// included as another.
    bool is_same(const SourceText& reading, const SourceText& text) const {
        std::error_code error;
        return &reading == &text
            || (&reading == &texts_.front()->text()
                && std::filesystem::equivalent(reading.name(), text.name(), error));
    }

    /// " through 'b.vera', 'c.vera'": the files between the text and the current one.
    std::string inclusion_path(const SourceText& text) const {
        std::string path;
        bool inside = false;
        for (const auto& reader : texts_) {
            const std::filesystem::path name = reader->text().name();
            if (inside)
                path += (path.empty() ? " through " : ", ") + shown(name.filename().string());
            inside = inside || is_same(reader->text(), text);
        }
        return path;
    }

    /// MESH "file" {MX | RT | TR | SC}
    void read_mesh_statement(const WordPlace& place) {
        const auto name = words().take_file_name();
        if (!name)
            return;
        const WordPlace name_place = words().last_place();
        optional_words_ = transformation_words;
        const auto placement = read_transformations(words());
        if (!placement)
            return;
        const auto path = files_.mesh_path(*name, name_place);
        if (!path)
            return;
        const auto materials = builder_.has_material() ? ObjMaterials::none : ObjMaterials::of_file;
        // Placed meshes are subscenes of their own, so that each file is in memory once, and so are
        // those of several parts.
        const auto key = std::pair(*path, materials);
        auto known = mesh_subscenes_.find(key);
        if (known == mesh_subscenes_.end()) {
            auto mesh = files_.mesh(*path, materials, name_place);
            if (mesh && !placement->moves && mesh->materials.empty())
                return builder_.add_mesh(path->string(), std::move(mesh->geometry), place);
            std::optional<SubsceneId> id;
            if (mesh)
                id = builder_.add_made_subscene(path->string(), std::move(*mesh), place);
            known = mesh_subscenes_.insert_or_assign(key, id).first;
        }
        if (known->second)
            builder_.add_call(*known->second, *placement, place);
    }

    /// MK name {parameter value} {MX | RT | TR | SC}
    void read_make(const WordPlace& place) {
        const auto part = read_made_part(words());
        if (!part)
            return;
        making_words_ = parameter_words(part->name);
        making_words_.insert(
            making_words_.end(), transformation_words.begin(), transformation_words.end());
        optional_words_ = making_words_;
        const auto placement = read_transformations(words());
        if (!placement || !limits_.generators)
            return;
        // What is made with the same values is in memory once.
        auto known = made_.find(part->key);
        if (known == made_.end())
            known = made_.emplace(part->key, made(*part, place)).first;
        if (known->second)
            builder_.add_call(*known->second, *placement, place);
    }

    std::optional<SubsceneId> made(const MadePart& part, const WordPlace& place) {
        try {
            return builder_.add_made_subscene(part.name, part.make(), place);
        } catch (const SurfaceError& error) {
            complaints_.error(part.place, error.what(), error.remedy);
            return std::nullopt;
        }
    }

    SceneLimits limits_;
    Complaints complaints_;
    SceneBuilder builder_;
    IncludedFiles files_;
    std::vector<std::unique_ptr<WordReader>> texts_; ///< each included by the one before it
    std::size_t inclusions_ = 0;
    std::map<std::pair<std::filesystem::path, ObjMaterials>, std::optional<SubsceneId>>
        mesh_subscenes_;
    std::map<std::string, std::optional<SubsceneId>> made_; ///< by MadePart::key
    std::vector<std::string_view> making_words_;            ///< that optional_words_ may show
    std::string_view complete_; ///< the keyword of the statement read last, if it was right
    std::span<const std::string_view> optional_words_; ///< that could have gone on with it
};

} // namespace

SceneFile read_vera_scene(const SourceText& text, const SceneLimits& limits) {
    return VeraReader(text, limits).read();
}

} // namespace vera
