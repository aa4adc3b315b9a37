// SPDX-License-Identifier: Apache-2.0
#include "vera/base/output_file.h"
#include "vera/formats/read_scene.h"
#include "vera/formats/source_text.h"
#include "vera/formats/text_edits.h"
#include "vera/solids/solid_findings.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "command.h"
#include "interrupt.h"
#include "item_places.h"
#include "messages.h"
#include "prepared_scene.h"
#include "progress_display.h"
#include "scene_fixes.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace vera {

namespace {

/// What the file is called in the working folder; nothing where it lies outside of that.
std::optional<std::string> name_in_working_folder(const std::string& path) {
    const std::filesystem::path name =
        std::filesystem::absolute(path).lexically_normal().lexically_relative(
            std::filesystem::current_path());
    if (name.empty() || *name.begin() == "..")
        return std::nullopt;
    return name.string();
}

/// "a/scene.vera", as git writes it and `patch -p1` and `git apply` read it: they take neither
/// absolute paths nor ones that lead out of the folder.
std::string diff_name(const char* side, const std::string& file) {
    // A tab ends names that hold spaces.
    return fmt::format("{}/{}{}", side, file, file.find(' ') == std::string::npos ? "" : "\t");
}

void print_diff(
    const std::string& path,
    std::string_view text,
    const SceneFixes& fixes,
    const Console& console) {
    const auto inside = name_in_working_folder(path);
    const std::string name = inside.value_or(std::filesystem::path(path).filename().string());
    fmt::print("{}", unified_diff(text, fixes.edits, diff_name("a", name), diff_name("b", name)));
    if (!inside && !fixes.edits.empty())
        print_note(fmt::format("the diff is for 'patch -p1' in the folder of '{}'", path), console);
}

struct Request {
    SceneRequest scene;
    bool strict = false;
    bool fix = false;
    std::string write; ///< where the corrected text goes; empty: nowhere
    double threads = 0;
    bool json = false;
};

/// What is found of the solids, as diagnostics: of each kind the first few, the rest counted.
class SolidDiagnostics {
public:
    SolidDiagnostics(const Scene& scene, bool with_notes, std::vector<Diagnostic>& diagnostics)
        : scene_(scene)
        , places_(scene)
        , with_notes_(with_notes)
        , diagnostics_(diagnostics)
        , known_(diagnostics.size()) {}

    void add(const SolidFinding& finding) {
        const bool is_note = finding.severity == Severity::note;
        if (is_note && !with_notes_) {
            ++notes_left_out_;
            return;
        }
        if (++counts_[{finding.kind, finding.severity}] > most_of_a_kind)
            return;
        Diagnostic diagnostic = places_.diagnostic(
            finding.severity,
            finding.geometry(scene_),
            finding.item,
            finding.triangle,
            finding.problem + triangle_text(finding),
            finding.remedy);
        // The reader has its own look at inner points, and has spoken of the worst.
        const auto known = std::span(diagnostics_).first(known_);
        if (finding.kind == SolidFinding::Kind::wrong_inner_point
            && std::ranges::find(known, diagnostic.place, &Diagnostic::place) != known.end())
            return;
        diagnostics_.push_back(std::move(diagnostic));
    }

    void add_rest() {
        for (const auto& [kind, count] : counts_)
            if (count > most_of_a_kind)
                diagnostics_.push_back(diagnostic_of(
                    kind.second,
                    scene_,
                    std::nullopt,
                    fmt::format("{} more {}", count - most_of_a_kind, name_of(kind.first)),
                    ""));
    }

    std::size_t notes_left_out() const { return notes_left_out_; }

private:
    static constexpr std::size_t most_of_a_kind = 10;

    /// " (at triangle 12)" of a mesh.
    static std::string triangle_text(const SolidFinding& finding) {
        return finding.triangle ? fmt::format(" (at triangle {})", *finding.triangle + 1) : "";
    }

    const Scene& scene_;
    ItemPlaces places_;
    bool with_notes_;
    std::vector<Diagnostic>& diagnostics_;
    std::size_t known_; ///< diagnostics of others
    std::map<std::pair<SolidFinding::Kind, Severity>, std::size_t> counts_;
    std::size_t notes_left_out_ = 0;
};

std::string counted(std::size_t count, const char* what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

/// ", with 1 warning and 2 notes (--strict shows them)", or nothing.
std::string what_was_found(const std::vector<Diagnostic>& diagnostics, std::size_t left_out) {
    const auto warnings = static_cast<std::size_t>(
        std::ranges::count(diagnostics, Severity::warning, &Diagnostic::severity));
    const std::size_t notes = diagnostics.size() - warnings + left_out;
    if (warnings + notes == 0)
        return "";
    std::string text = ", with ";
    if (warnings > 0)
        text += counted(warnings, "warning");
    if (warnings > 0 && notes > 0)
        text += " and ";
    if (notes > 0)
        text += counted(notes, "note");
    if (left_out > 0)
        text += left_out == 1 ? " (--strict shows it)" : " (--strict shows them)";
    return text;
}

/// A scene whose text can be changed: one of the language, in a file that can be read again.
void refuse_what_cannot_be_fixed(const Request& request) {
    if (!request.write.empty() && !request.fix)
        throw CommandLineError("--write says where --fix writes the scene: give --fix too");
    if (!request.fix)
        return;
    if (request.scene.path == "-" || format_of(request.scene) != SceneFormat::vera)
        throw CommandLineError("--fix changes the text of a scene in the VERA language; save it as "
                               "a .vera file first");
    if (request.json)
        throw CommandLineError(
            "--fix writes a diff to standard output, --json diagnostics: take one");
}

/// Proposes corrections as a diff, or writes the corrected text.
void fix_scene(
    const Request& request,
    const PreparedScene& prepared,
    std::vector<SolidFinding> findings,
    const Console& console) {
    if (!request.strict)
        std::erase_if(findings, [](const SolidFinding& finding) {
            return finding.severity == Severity::note;
        });
    const SourceText text(request.scene.path);
    const SceneFixes fixes = scene_fixes(prepared, findings, text.text(), console.cancel);
    if (request.write.empty()) {
        print_diff(request.scene.path, text.text(), fixes, console);
    } else {
        OutputFile file(request.write);
        file.write(edited(text.text(), fixes.edits));
        file.commit();
    }
    std::string message = fixes.fixed == 0 ? "nothing to correct"
        : request.write.empty()            ? "corrects " + counted(fixes.fixed, "finding")
                                           : "corrected " + counted(fixes.fixed, "finding");
    if (fixes.left > 0)
        message += fmt::format(
            "; {} cannot be corrected without knowing more: see its remedy",
            counted(fixes.left, "finding"));
    print_note(fmt::format("{}: {}", request.scene.path, message), console);
}

void check_scene(const Request& request, Console& console) {
    refuse_what_cannot_be_fixed(request);
    const ThreadLimit limit = thread_limit(request.threads);
    stop_on_interrupt(console);
    std::vector<Diagnostic> diagnostics;
    std::size_t left_out = 0;
    try {
        PreparedScene prepared = prepared_scene(request.scene);
        diagnostics = std::move(prepared.warnings);
        ProgressDisplay display(console, "solids");
        std::vector<SolidFinding> findings =
            solid_findings(prepared.scene, display.callback(), &console.cancel);
        SolidDiagnostics of_solids(prepared.scene, request.strict, diagnostics);
        for (const SolidFinding& finding : findings)
            of_solids.add(finding);
        of_solids.add_rest();
        left_out = of_solids.notes_left_out();
        if (request.fix) {
            print_diagnostics(diagnostics, console);
            fix_scene(request, prepared, std::move(findings), console);
            return;
        }
    } catch (const InputError& error) {
        if (request.json)
            fmt::print("{}\n", to_json(error.diagnostics()));
        throw;
    }
    if (request.json) {
        fmt::print("{}\n", to_json(diagnostics));
        return;
    }
    print_diagnostics(diagnostics, console);
    if (!console.quiet)
        fmt::print("{}: good{}\n", request.scene.path, what_was_found(diagnostics, left_out));
}

} // namespace

/// vera check SCENE
void add_check_command(CLI::App& app, Console& console) {
    const auto request = std::make_shared<Request>();

    CLI::App* check = app.add_subcommand("check", "what is wrong or doubtful in a scene");
    add_scene_options(*check, request->scene);
    check->add_flag(
        "--strict",
        request->strict,
        "notes as well: solids that are open, faces that pass through each other or coincide in "
        "part");
    check->add_flag(
        "--fix",
        request->fix,
        "proposes corrections of the warnings, with --strict of the notes too, as a diff on "
        "standard output");
    check->add_option("--write", request->write, "with --fix: writes the corrected scene there")
        ->type_name("FILE");
    check->add_flag("--json", request->json, "the diagnostics as JSON, on standard output");
    add_threads_option(*check, request->threads);
    add_console_options(*check, console);
    check->footer("Exits with 0 when the scene can be rendered, warnings or not, else with 1.\n"
                  "Examples:\n"
                  "  vera check scene.vera\n"
                  "  vera check scene.vera --strict\n"
                  "  vera check scene.vera --fix | patch -p1\n"
                  "  vera check scene.vera --fix --write better.vera\n"
                  "  vera check scene.vera -c scene.ctl --json");

    check->callback([request, &console] { check_scene(*request, console); });
}

} // namespace vera
