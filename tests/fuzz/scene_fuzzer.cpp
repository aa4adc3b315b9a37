// SPDX-License-Identifier: Apache-2.0
#include "vera/base/check.h"
#include "vera/formats/statement_words.h"
#include "vera/formats/vera_scene.h"
#include "vera/solids/solid_findings.h"

#include <cstdint>
#include <string>

/// Whatever the text, it is a scene or a list of errors. It is named after a folder that is not
/// there, so that it includes nothing.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const vera::SourceText text(
        "no-such-folder/fuzz.vera", std::string(reinterpret_cast<const char*>(data), size));
    try {
        const vera::SceneFile file = vera::read_vera_scene(text, {.generators = false});
        const vera::Scene& scene = file.scene;
        for (const vera::Item& item : scene.geometry.items)
            VERA_CHECK(
                item.material == vera::inherited_material
                || static_cast<std::size_t>(item.material) < scene.materials.size());
        VERA_CHECK(scene.geometry.element_count == scene.geometry.items.size());
        // Those who change a text find the reader's statements in it, and what checks solids ends.
        for (const vera::StatementWords& statement : vera::statement_words(text.text()))
            VERA_CHECK(
                !statement.words.empty()
                && statement.words.back().offset + statement.words.back().length <= size);
        for (const vera::SolidFinding& finding : vera::solid_findings(scene))
            VERA_CHECK(finding.item < finding.geometry(scene).items.size());
    } catch (const vera::InputError& error) {
        VERA_CHECK(!error.diagnostics().empty());
        for (const vera::Diagnostic& diagnostic : error.diagnostics())
            VERA_CHECK(!vera::to_text(diagnostic).empty());
    }
    return 0;
}
