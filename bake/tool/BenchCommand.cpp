#include "bake/base/Error.h"
#include "bake/pipeline/BakeOptions.h"
#include "bake/scene/SceneFile.h"
#include "bake/table/Bench.h"
#include "bake/table/TableKernels.h"
#include "bake/tool/Command.h"

#include <fmt/format.h>

namespace tss::tool {

namespace {

struct BenchArguments {
    std::string scene, pair, kernel = "best", with = "hit";
    std::uint64_t queries = 10'000'000;
};

std::string cellText(const PreparedTable& table) {
    const TableCells& cells = table.kernels().cells();
    if (!table.kernels().clusters().empty())
        return fmt::format("; {} clusters in {} groups", table.kernels().clusters().count(),
                           table.kernels().clusters().levels()[1].size());
    if (cells.empty()) return "";
    return fmt::format("; {} cells, in which it looks at {:.2g} % of the tests", cells.rowCount() - 1,
                       100 * cells.looked());
}

void runBench(const BenchArguments& arguments, const Console& console) {
    PrepareOptions options;
    BenchWith with{};
    if (!kernelTarget(arguments.kernel, options.target))
        throw InputError("--kernel: expected best, scalar, sse2, avx2, avx512 or neon, found \"" +
                         arguments.kernel + "\"");
    if (!benchWith(arguments.with, with))
        throw InputError("--with: expected hit, gap, contact, features or pose, found \"" + arguments.with +
                         "\"");
    const SceneModel scene = loadScene(arguments.scene);
    const Pair& pair = chooseFreshPair(scene, arguments.pair, arguments.scene);
    if (!pair.table) throw InputError(Where{arguments.scene, "", pair.path}, "has no table to be timed");
    const PreparedTable table(*pair.table, options);
    const BenchResult result = benchQueries(table, pair.table->motion, arguments.queries, with);
    console.answer(fmt::format("{}: {}, {} bytes; {} {} of {} features, {}{}", pair.path,
                               counted(table.testCount(), "test"), table.bytes(), name(table.precision()),
                               name(table.form()), table.kernels().featureCount(), name(table.target()),
                               cellText(table)));
    console.answer(fmt::format("{} queries ({}): {:.2f} ns each, features of a pose {:.2f} ns{}; {} hits",
                               arguments.queries, arguments.with, result.nanoseconds,
                               result.featureNanoseconds, with == BenchWith::Pose ? "" : " more",
                               result.hits));
    console.answer(fmt::format(
        "rounding: no touch missed, none reported from farther than {}; gaps within {}",
        lengthText(table.signBand(), scene.metersPerUnit), lengthText(table.gapBand(), scene.metersPerUnit)));
    console.print({{"path", pair.path},
                   {"tests", table.testCount()},
                   {"bytes", table.bytes()},
                   {"kernel", name(table.target())},
                   {"form", name(table.form())},
                   {"precision", name(table.precision())},
                   {"features", table.kernels().featureCount()},
                   {"cells", table.kernels().cells().empty() ? 0 : table.kernels().cells().rowCount() - 1},
                   {"looked", table.kernels().cells().looked()},
                   {"clusters", table.kernels().clusters().count()},
                   {"with", arguments.with},
                   {"queries", arguments.queries},
                   {"ns", result.nanoseconds},
                   {"featureNs", result.featureNanoseconds},
                   {"hits", result.hits},
                   {"signBand", table.signBand()},
                   {"gapBand", table.gapBand()}});
}

} // namespace

void addBench(CLI::App& app, Console& console) {
    CLI::App* command =
        addCommand(app, console, "bench", "times the query alone, over poses made beforehand");
    auto arguments = std::make_shared<BenchArguments>();
    command->add_option("scene", arguments->scene, "a baked scene")->required();
    command->add_option("--pair", arguments->pair, "prim path of the pair (not needed when there is one)");
    command->add_option("--queries", arguments->queries, "how many")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command->add_option("--kernel", arguments->kernel, "best, scalar, sse2, avx2, avx512 or neon")
        ->capture_default_str();
    command
        ->add_option("--with", arguments->with,
                     "hit, gap (and test), contact (and point, normal, gradient), features (of the poses, no "
                     "query) or pose (hit, features included)")
        ->capture_default_str();
    command->footer("Instructions a query: run under callgrind with two values of --queries and divide the "
                    "difference.\n" +
                    app.get_footer());
    command->callback([arguments, &console] { runBench(*arguments, console); });
}

} // namespace tss::tool
