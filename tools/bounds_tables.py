#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Fills the tables of docs/bounds.md from what `vera bench curve all --json` has written: usage: tools/bounds_tables.py CURVES.json"""

import json
import re
import sys
from pathlib import Path

DOCUMENT = Path(__file__).resolve().parent.parent / "docs" / "bounds.md"
PART = re.compile(r"(<!-- table: (growth|terms) -->\n).*?(<!-- end -->)", re.DOTALL)


def whole(number):
    text = f"{number:.0f}"
    return f"{number:,.0f}".replace(",", " ") if len(text) > 4 else text


def coefficient(number):
    """Three digits."""
    text = f"{number:.3g}"
    return whole(float(text)) if "e" in text or abs(float(text)) >= 1000 else text


def follows(curve):
    """The formulas that Akaike's criterion does not tell apart, the best one first."""
    best = sorted(curve["models"], key=lambda model: model["aic_above_best"])
    formulas = [model["formula"].removeprefix("c ") for model in best if model["aic_above_best"] < 2]
    return ", or ".join(formula[1:-1] if formula.startswith("(") and formula.endswith(")") else formula for formula in formulas)


def foretold(curve):
    best = min(curve["models"], key=lambda model: model["aic_above_best"])
    return f"{100 * best['prediction_error']:.0f} %"


def verdict(curve):
    text = "**above**" if curve["verdict"] == "above" else curve["verdict"]
    return text if curve["bootstrap_verdict"] == curve["verdict"] else f"{text}, by the bootstrap {curve['bootstrap_verdict']}"


def growth_table(curves):
    rows = ["| curve | sizes fitted (how many) | grows as n^ | by the bootstrap | bound | as n^ | verdict | follows best (AIC) | foretold within |",
            "| --- | ---: | ---: | ---: | --- | ---: | --- | --- | ---: |"]
    for curve in curves:
        fitted = [size for size in curve["sizes"] if size >= curve["first_fitted"]]
        low, high = curve["bootstrap_interval"]
        rows.append(
            f"| {curve['name']}/{curve['family']} | {whole(fitted[0])} to {whole(fitted[-1])} ({len(fitted)}) "
            f"| {curve['exponent']:.2f} ± {curve['half_interval']:.2f} | {low:.2f} to {high:.2f} | {curve['bound']} "
            f"| {curve['bound_exponent']:.2f} | {verdict(curve)} | {follows(curve)} | {foretold(curve)} |")
    return "\n".join(rows)


def told(found):
    if found is None:
        return "not told"
    low, high = found["interval"]
    if found["value"] == 0 and high == 0:
        return "0 (else negative)"
    return f"{coefficient(found['value'])} ({coefficient(low)} to {coefficient(high)})"


def terms_table(structures):
    most = max(len(structure["terms"]) for structure in structures)
    rows = ["| |" + " |" * most + " off by |", "| --- |" + " ---: |" * (most + 1)]

    def row(head, cells, last=""):
        rows.append(f"| {head} | " + " | ".join([*cells, *[""] * (most - len(cells)), last]) + " |")

    for structure in structures:
        row(f"**{structure['name']}**", [f"c{i + 1}, of {term}" for i, term in enumerate(structure["terms"])])
        for family in [*structure["families"], *([{"family": "all together", **structure["together"]}] if structure["together"] else [])]:
            row(family["family"], [told(one) for one in family["coefficients"]], f"{100 * family['error']:.1f} %")
        row("one for all", [{True: "may be one", False: "differs", None: ""}[one] for one in structure["one_for_all"]])
    return "\n".join(rows)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    found = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    tables = {"growth": growth_table(found["curves"]), "terms": terms_table(found["structures"])}
    text = DOCUMENT.read_text(encoding="utf-8")
    DOCUMENT.write_text(PART.sub(lambda match: f"{match[1]}\n{tables[match[2]]}\n\n{match[3]}", text), encoding="utf-8")
    print(DOCUMENT.name)


if __name__ == "__main__":
    main()
