// SPDX-License-Identifier: Apache-2.0
#include "vera/base/output_file.h"
#include "vera/base/progress_part.h"
#include "vera/base/version.h"
#include "vera/image/image_difference.h"
#include "vera/image/image_file.h"
#include "vera/render/effect_ladder.h"
#include "vera/render/render_scene.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <system_error>

#include "command.h"
#include "interrupt.h"
#include "ladder_sheet.h"
#include "messages.h"
#include "option_values.h"
#include "picture_metadata.h"
#include "prepared_scene.h"
#include "progress_display.h"
#include "scene_index.h"
#include "stopwatch.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace vera {

namespace {

namespace fs = std::filesystem;

/// Written last: a folder that has it holds all the rest.
constexpr char report_name[] = "ladder.json";

struct Request {
    SceneRequest scene;
    std::string folder;
    std::optional<double> width;
    double threads = 0;
    bool overwrite = false;
    bool json = false;
};

/// A step that was rendered.
struct Rung {
    Image image;
    PictureSettings settings;
    RenderStatistics counts;
    double seconds = 0;
    std::optional<ImageDifference> difference; ///< to the step before
    std::string unchanged;                     ///< why nothing differs; empty where something does
};

struct StepWords {
    const char* file;
    const char* title;
    const char* text;
};

constexpr std::array<StepWords, effect_steps.size()> step_words = {{
    {"1-flat",
     "Plain colours",
     "No light: each surface in the colour of its material. One ray a pixel makes stairs of "
     "edges."},
    {"2-antialiased",
     "Smooth edges",
     "Anti-aliasing: pixels that differ from their neighbours get more rays."},
    {"3-diffuse",
     "Diffuse light",
     "Ambient light and the first light source, by the angle at which they fall. Shapes are seen."},
    {"4-highlights",
     "All lights, with highlights",
     "Every light source, and highlights. A depth buffer would do for this."},
    {"5-rays",
     "Shadows, mirrors and glass",
     "Rays to the light sources, and mirrored and refracted ones."},
}};

/// The folder that takes the files. Where it was made here and nothing came into it, it goes again.
class OutputFolder {
public:
    OutputFolder(const fs::path& path, bool overwrite)
        : path_(path) {
        if (path == "-")
            throw CommandLineError("a ladder is a folder of pictures: standard output cannot take "
                                   "it; name a folder, as in -o steps");
        const fs::file_status status = fs::status(path);
        if (!fs::exists(status)) {
            make();
            return;
        }
        if (!fs::is_directory(status))
            throw CommandLineError(fmt::format(
                "'{}' is a file; --output takes a folder, which is made where it is missing",
                path.string()));
        if (!overwrite && !fs::is_empty(path) && !fs::exists(path / report_name))
            throw CommandLineError(fmt::format(
                "the folder '{}' holds files that 'vera ladder' did not write; name a new one, or "
                "give --overwrite",
                path.string()));
    }

    ~OutputFolder() {
        std::error_code ignored;
        if (made_)
            fs::remove(path_, ignored); // only where it is empty
    }

    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

    fs::path file(const std::string& name) const { return path_ / name; }

private:
    void make() {
        std::error_code error;
        made_ = fs::create_directory(path_, error);
        if (error)
            throw std::system_error(
                error,
                fmt::format(
                    "cannot make the folder '{}'; make the one that it is to stand in, or name "
                    "another",
                    path_.string()));
    }

    fs::path path_;
    bool made_ = false;
};

/// The raster with that width, in the same proportions.
void set_width(PictureSettings& settings, double width) {
    const std::uint32_t wanted = whole_of("--width", width, 1, PictureLimits::longest_side);
    const double height =
        std::round(static_cast<double>(settings.height) * wanted / settings.width);
    if (height > PictureLimits::longest_side)
        throw CommandLineError(fmt::format(
            "--width {} makes a picture {:.0f} pixels high, and {} is the most; take a smaller "
            "width",
            wanted,
            height,
            PictureLimits::longest_side));
    settings.width = wanted;
    settings.height = static_cast<std::uint32_t>(std::max(height, 1.0));
}

/// The light as EXPMES makes it for the whole picture; all steps are shown in it.
void expose_all_steps(PreparedScene& prepared, const RayIndex& index, const CancelFlag& cancel) {
    if (!prepared.settings.exposure)
        return;
    TracedScene traced = traced_scene(prepared.scene, index, prepared.settings, &cancel);
    RenderStatistics not_of_a_step;
    const double factor =
        expose(traced, prepared.camera, *prepared.settings.exposure, not_of_a_step).factor;
    prepared.scene.lights = traced.illumination.lights;
    prepared.settings.ambient = traced.illumination.ambient;
    // So that the settings tell of it.
    prepared.settings.light_factors.resize(prepared.scene.lights.size(), 1);
    for (double& light_factor : prepared.settings.light_factors)
        light_factor *= factor;
    prepared.settings.exposure.reset();
}

/// Renders every step. Of the scene, lights and materials are those of the last step afterwards.
std::vector<Rung>
rungs(PreparedScene& prepared, const Effects& all, const RayIndex& index, const Console& console) {
    ProgressDisplay display(console, "render");
    // The last step has most of the rays.
    StageProgress stages(display.callback(), effect_steps.size() + 3);
    std::vector<Rung> result;
    for (const EffectStep step : effect_steps) {
        const Effects effects = effects_at(step, all);
        prepared.scene.lights = effects.lights;
        prepared.scene.materials = effects.materials;
        Stopwatch watch;
        RenderResult rendered = render_scene(
            prepared.scene,
            prepared.camera,
            index,
            effects.settings,
            SampleType::integer8,
            stages.next(step == EffectStep::rays ? 4 : 1),
            &console.cancel);
        Rung rung;
        rung.seconds = watch.lap();
        rung.image = std::move(rendered.image);
        rung.settings = effects.settings;
        rung.counts = rendered.statistics;
        if (!result.empty()) {
            rung.difference = difference(result.back().image, rung.image);
            if (rung.difference->changed_pixels == 0)
                rung.unchanged = why_unchanged(step, all).value_or("nothing in view shows it");
        }
        result.push_back(std::move(rung));
    }
    return result;
}

std::string picture_name(std::size_t step) {
    return std::string(step_words[step].file) + ".png";
}

/// Of a step and the one before.
std::string difference_name(std::size_t step) {
    return fmt::format("difference-{}-{}.png", step, step + 1);
}

nlohmann::ordered_json rays_json(const RenderStatistics& counts) {
    return {
        {"view_rays", counts.view_rays},
        {"extra_view_rays", counts.extra_view_rays},
        {"probe_rays", counts.probe_rays},
        {"shadow_rays", counts.shadow_rays},
        {"mirrored_rays", counts.mirrored_rays},
        {"refracted_rays", counts.refracted_rays}};
}

nlohmann::ordered_json report_json(
    const Request& request, const PictureSettings& settings, const std::vector<Rung>& rungs) {
    nlohmann::ordered_json json = {
        {"version", 1},
        {"program", fmt::format("vera {}", version)},
        {"scene", request.scene.path},
        {"width", settings.width},
        {"height", settings.height},
        {"settings", control_text(settings)},
        {"sheet", "sheet.svg"},
        {"steps", nlohmann::ordered_json::array()}};
    for (std::size_t i = 0; i < rungs.size(); ++i) {
        const Rung& rung = rungs[i];
        nlohmann::ordered_json step = {
            {"picture", picture_name(i)},
            {"title", step_words[i].title},
            {"rays", rays_json(rung.counts)},
            {"tests", rung.counts.queries.tests},
            {"seconds", rung.seconds}};
        if (rung.difference)
            step["difference"] = {
                {"picture", difference_name(i)},
                {"factor", rung.difference->factor},
                {"changed_pixels", rung.difference->changed_pixels},
                {"mean", rung.difference->mean},
                {"largest", rung.difference->largest}};
        if (!rung.unchanged.empty())
            step["unchanged"] = rung.unchanged;
        json["steps"].push_back(std::move(step));
    }
    return json;
}

/// As 'vera render' writes it, with the step's own settings and title.
PictureMetadata
step_metadata(PictureMetadata metadata, const PictureSettings& settings, const char* title) {
    for (auto& [name, text] : metadata)
        if (name == "Settings")
            text = control_text(settings);
    metadata.emplace_back("Title", title);
    return metadata;
}

void write_pictures(
    const OutputFolder& folder, const PreparedScene& prepared, const std::vector<Rung>& rungs) {
    const PictureMetadata of_scene = picture_metadata(prepared);
    for (std::size_t i = 0; i < rungs.size(); ++i) {
        const PictureMetadata metadata =
            step_metadata(of_scene, rungs[i].settings, step_words[i].title);
        write_image(rungs[i].image, folder.file(picture_name(i)), ImageFileFormat::png8, metadata);
        if (rungs[i].difference)
            write_image(
                rungs[i].difference->image,
                folder.file(difference_name(i)),
                ImageFileFormat::png8,
                {{"Software", fmt::format("vera {}", version)},
                 {"Amplified", std::to_string(rungs[i].difference->factor)}});
    }
}

std::string bytes_of_file(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (!file)
        throw std::system_error(
            std::make_error_code(std::errc::io_error),
            fmt::format("cannot read '{}' again", path.string()));
    return bytes;
}

std::string difference_text(const ImageDifference& difference, std::size_t step) {
    if (difference.changed_pixels == 0)
        return fmt::format("No difference to {}", step);
    if (difference.factor == 1)
        return fmt::format("Difference to {}", step);
    return fmt::format("Difference to {}, times {}", step, difference.factor);
}

/// Embeds the files of the pictures as they were written.
Sheet sheet_of(
    const Request& request,
    const PictureSettings& settings,
    const OutputFolder& folder,
    const std::vector<Rung>& rungs) {
    Sheet sheet;
    sheet.title = request.scene.path == "-" ? "A scene" : fs::path(request.scene.path).filename();
    sheet.width = settings.width;
    sheet.height = settings.height;
    for (std::size_t i = 0; i < rungs.size(); ++i) {
        const Rung& rung = rungs[i];
        SheetStep step;
        step.title = step_words[i].title;
        step.text = step_words[i].text;
        if (!rung.unchanged.empty())
            step.text = fmt::format("Changes nothing here: {}.", rung.unchanged);
        step.picture = bytes_of_file(folder.file(picture_name(i)));
        if (rung.difference) {
            step.difference = bytes_of_file(folder.file(difference_name(i)));
            step.difference_text = difference_text(*rung.difference, i);
        }
        step.counts = rung.counts;
        step.seconds = rung.seconds;
        sheet.steps.push_back(std::move(step));
    }
    return sheet;
}

void print_rungs(const std::vector<Rung>& rungs, const Console& console) {
    for (std::size_t i = 0; i < rungs.size(); ++i) {
        const RenderStatistics& counts = rungs[i].counts;
        print_note(
            fmt::format(
                "{}: {} view, {} probe, {} shadow, {} mirrored, {} refracted; {}{}",
                picture_name(i),
                counts.view_rays,
                counts.probe_rays,
                counts.shadow_rays,
                counts.mirrored_rays,
                counts.refracted_rays,
                duration_text(rungs[i].seconds),
                rungs[i].unchanged.empty() ? "" : "; changes nothing: " + rungs[i].unchanged),
            console);
    }
}

void write_ladder(const Request& request, const Console& console) {
    const ThreadLimit limit = thread_limit(request.threads);
    PreparedScene prepared = prepared_scene(request.scene);
    if (request.width)
        set_width(prepared.settings, *request.width);
    print_diagnostics(prepared.warnings, console);
    give_fallback_material(prepared.scene);

    const OutputFolder folder(request.folder, request.overwrite);
    // Opened before the long work, so that a folder that cannot be written to shows at once.
    OutputFile report(folder.file(report_name));
    const CancellableWork work;
    const std::unique_ptr<RayIndex> index = scene_index(prepared.scene, {}, {}, console.cancel);
    expose_all_steps(prepared, *index, console.cancel);
    const Effects all = {prepared.scene.lights, prepared.scene.materials, prepared.settings};
    const std::vector<Rung> steps = rungs(prepared, all, *index, console);

    // What is there of an earlier run is not complete from here on.
    std::error_code none_before;
    fs::remove(folder.file(report_name), none_before);
    write_pictures(folder, prepared, steps);
    OutputFile sheet(folder.file("sheet.svg"));
    sheet.write(sheet_svg(sheet_of(request, prepared.settings, folder, steps)));
    sheet.commit();
    const std::string json = report_json(request, prepared.settings, steps).dump(2) + "\n";
    report.write(json);
    report.commit();

    print_rungs(steps, console);
    if (request.json)
        fmt::print("{}", json);
}

} // namespace

/// vera ladder SCENE -o DIR
void add_ladder_command(CLI::App& app, Console& console) {
    const auto request = std::make_shared<Request>();

    CLI::App* command = app.add_subcommand(
        "ladder", "the same scene with one effect more each time, and what each costs");
    add_scene_options(*command, request->scene);
    command
        ->add_option(
            "-o,--output",
            request->folder,
            "folder for five pictures, their differences, sheet.svg with all of them, and "
            "ladder.json; made where it is missing")
        ->required()
        ->type_name("DIR");
    command
        ->add_option("--width", request->width, "pixels across; the height follows in proportion")
        ->type_name("N");
    command->add_flag(
        "--overwrite", request->overwrite, "write into a folder that holds other files as well");
    add_threads_option(*command, request->threads);
    command->add_flag("--json", request->json, "ladder.json on standard output as well");
    add_console_options(*command, console);
    command->footer("Examples:\n"
                    "  vera ladder scene.vera -o steps\n"
                    "  vera ladder scene.vera -c scene.ctl -o steps --width 640\n"
                    "  vera ladder bunny.obj -o steps --overwrite --json");

    command->callback([request, &console] { write_ladder(*request, console); });
}

} // namespace vera
