// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace CLI {
class App;
} // namespace CLI

namespace vera {

struct Console;

// The commands of 'vera bench'.
void add_bench_curve(CLI::App& bench, Console& console);
void add_bench_figure(CLI::App& bench, Console& console);

} // namespace vera
