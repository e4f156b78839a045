#include "bake/tool/Summary.h"

#include "bake/pipeline/BakeOptions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tss::tool {

namespace {

std::string line(const char* label, const std::string& text) {
    return fmt::format("  {:<12} {}\n", label, text);
}

std::string lengthOrUnknown(const Json& value, double metersPerUnit) {
    return value.is_null() ? "not known" : lengthText(value.get<double>(), metersPerUnit);
}

/// How far apart the meshes are at rest, how often contact is reported early, and what helps where the joint
/// has too little room.
std::string earlyContactLines(const Json& pair, double metersPerUnit) {
    const Json& early = pair["earlyContact"];
    const int poses = early["poses"].get<int>(), freePoses = early["freePoses"].get<int>();
    const double clearance = pair["clearanceAtRest"].get<double>();
    std::string text =
        line("meshes",
             fmt::format("{} at rest; contact reported at {:.0f} % of {} poses where {}",
                         clearance > 0 ? lengthText(clearance, metersPerUnit) + " apart" : "touch or overlap",
                         100 * early["share"].get<double>(), freePoses,
                         pair.value("restRegion", Json()).is_null() ? "they do not touch"
                                                                    : "nothing else touches"));
    // --at-rest ignore is no advice for a pair that is baked that way already.
    const bool ignored = pair.value("ignoresRest", false);
    const char* ignoreAdvice = ignored ? ""
                                       : "; where the bodies overlap on purpose, as in\n               a "
                                         "socket, bake with --at-rest ignore";
    if (early["stuck"].get<bool>() && !ignored)
        text += line("stuck",
                     fmt::format("the meshes touch or overlap at {} of {} poses. Where B does not lie right, "
                                 "move it (tss\n               make --b-offset){}",
                                 poses - freePoses, poses, ignoreAdvice));
    else if (early["held"].get<bool>())
        text += line("held",
                     fmt::format("at rest: every small step from there is contact, whichever way. {}Let it "
                                 "rest where nothing\n               touches (tss make --rest, --b-offset){}",
                                 pair["dofs"].get<int>() > 1 ? "Where one value drives the\n               "
                                                               "others, as of gears, let a path say so (tss "
                                                               "make --dof path). "
                                                             : "",
                                 ignoreAdvice));
    if (early["touching"].get<bool>())
        text +=
            line("touching", fmt::format("the meshes touch at {} of {} poses: where they should not, look "
                                         "at origin, axis and limits",
                                         poses - freePoses, poses));
    if (!early["coarse"].get<bool>()) return text;
    text += line("too coarse", fmt::format("for the clearance of this joint: it {} where nothing touches",
                                           early["atRest"].get<bool>() ? "sticks at rest,"
                                                                       : "is stopped early, or sticks,"));
    if (!early["tolerance"].is_null())
        text += line("propose", fmt::format("--tolerance {}: contact at no more than {:.0f} % of those poses",
                                            lengthOption(early["tolerance"].get<double>(), metersPerUnit),
                                            100 * early["shareThen"].get<double>()));
    return text;
}

std::string areaText(double area, double metersPerUnit) {
    const double squareMetres = area * metersPerUnit * metersPerUnit;
    return squareMetres < 0.001 ? fmt::format("{:.3g} mm2", 1e6 * squareMetres)
           : squareMetres < 1   ? fmt::format("{:.3g} cm2", 1e4 * squareMetres)
                                : fmt::format("{:.3g} m2", squareMetres);
}

/// How much of the two surfaces the bounds are about, where that is not all of them.
std::optional<BoundedShares> boundedPart(const Json& item) {
    if (item.value("restRegion", Json()).is_null()) return std::nullopt;
    const Json& region = item["restRegion"];
    return boundedShares(region["shareA"].get<double>(), region["shareB"].get<double>());
}

/// What the bounds are not about. Empty: there is nothing.
std::string exemptLine(const Json& item, double metersPerUnit) {
    const Json region = item.value("restRegion", Json());
    if (region.is_null()) return "";
    const auto part = [&](const char* area, const char* share) {
        return fmt::format("{} ({:.3g} %)", areaText(region[area].get<double>(), metersPerUnit),
                           100 * region[share].get<double>());
    };
    const Json& depth = region["depth"];
    return line("exempt", fmt::format("contact of {} of A with {} of B, which overlap at rest: {}",
                                      part("areaA", "shareA"), part("areaB", "shareB"),
                                      depth.is_null() ? "never told"
                                                      : "told where they go deeper, spheres by " +
                                                            lengthText(depth.get<double>(), metersPerUnit)));
}

/// How the run time asks the table.
std::string kernelLines(const Json& kernel, double metersPerUnit) {
    std::string text =
        line("query",
             fmt::format("{} in {}, condition {:.3g}, verdicts right beyond {}",
                         kernel["form"].get<std::string>(), kernel["precision"].get<std::string>(),
                         kernel["condition"].get<double>(), lengthOrUnknown(kernel["band"], metersPerUnit)));
    if (kernel.contains("clusters")) {
        const Json& clusters = kernel["clusters"];
        text += line("clusters", fmt::format("{}, each of {} tests, in {} groups", clusters["count"].dump(),
                                             clusters["tests"].dump(), clusters["groups"].dump()));
    }
    if (kernel.contains("verdicts"))
        text += line("verdicts", fmt::format("tests are asked in {:.3g} % of the limits; {} bytes",
                                             100 * kernel["verdicts"]["asked"].get<double>(),
                                             kernel["verdicts"]["bytes"].dump()));
    return text;
}

/// boundEarly, and the smaller bound that holds while neither body stands inside the other.
std::string earlyText(const Json& item, double metersPerUnit) {
    const Json &always = item["boundEarly"], &unlessInside = item["earlyOfSolids"];
    if (unlessInside.is_null()) return lengthOrUnknown(always, metersPerUnit);
    const std::string text = lengthOrUnknown(unlessInside, metersPerUnit);
    if (always.is_null()) return text + " unless one body stands inside the other";
    // Where it is known that no part stands inside, the two bounds are nearly the same.
    return always.get<double>() <= 2 * unlessInside.get<double>()
               ? lengthOrUnknown(always, metersPerUnit)
               : fmt::format("{}, {} where one body stands inside the other", text,
                             lengthOrUnknown(always, metersPerUnit));
}

bool isSkin(const Json& item) {
    return item.contains("travel");
}

/// No sphere was made of a body of a pair, though it has a surface.
bool hasNoSpheres(const Json& item) {
    return (item["spheresA"] == 0 || item["spheresB"] == 0) && item["boundMiss"].is_null() && !isSkin(item);
}

std::string skinTableLines(const Json& item, double metersPerUnit) {
    std::string text;
    if (const double travel = item["travel"].get<double>(); travel > 0)
        text += line("good", fmt::format("while skin strays no farther than {} from where muscles and bones "
                                         "carry it",
                                         lengthText(travel, metersPerUnit)));
    if (!item["certified"].get<bool>())
        text += line("explored", "each muscle and joint value by itself, then joints together, from limit to "
                                 "limit: nothing is proven");
    if (item.contains("residual"))
        text += line("residual", fmt::format("{} at most: so deep it goes into what is below it, beyond its "
                                             "depth at rest, in {} steps\n               of the scene's own "
                                             "motion",
                                             lengthOrUnknown(item["residual"], metersPerUnit),
                                             item["residualSteps"].dump()));
    return text;
}

std::string boundsText(const Json& item, double metersPerUnit) {
    const std::optional<BoundedShares> part = boundedPart(item);
    if (part && part->none()) return "none: all of A and of B is exempt, and nothing is proven";
    return fmt::format("{}miss {}, early {}, epsilon {}, {}", part ? "for " + boundedText(*part) + ": " : "",
                       lengthOrUnknown(item["boundMiss"], metersPerUnit), earlyText(item, metersPerUnit),
                       lengthOrUnknown(item["epsilon"], metersPerUnit),
                       hasNoSpheres(item)              ? "of no spheres"
                       : item["certified"].get<bool>() ? "certified for every pose"
                                                       : "sampled poses only");
}

/// That a pair never collides, which is proven.
std::string proofLine(const Json& item, double metersPerUnit) {
    const std::optional<BoundedShares> part = boundedPart(item);
    if (part && part->none())
        return line("bounds", boundsText(item, metersPerUnit)) + exemptLine(item, metersPerUnit);
    return fmt::format(
               "  never collide{}: the surfaces stay more than {} apart over the whole motion; no table, "
               "no callback\n",
               part ? ", for " + boundedText(*part) : "", lengthOrUnknown(item["clearance"], metersPerUnit)) +
           exemptLine(item, metersPerUnit);
}

std::string tableLines(const Json& item, double metersPerUnit) {
    std::string text = line("used", fmt::format("{} + {}", item["usedA"].dump(), item["usedB"].dump()));
    text +=
        line("tests a step", fmt::format("{} ({} products)", item["tests"].dump(), item["products"].dump()));
    const Json &pairs = item["candidatePairs"], &least = item["lowerBound"];
    text += line(
        "can meet",
        (pairs.is_null() ? "more pairs than are counted" : counted(pairs.get<std::size_t>(), "pair")) +
            (least.is_null() ? ""
                             : "; no table has fewer than " + counted(least.get<std::size_t>(), "test")));
    if (isSkin(item)) return text + skinTableLines(item, metersPerUnit);
    if (hasNoSpheres(item))
        text += line("no spheres",
                     "were made of a body: the table reports no contact, and nothing is known of it");
    else if (item["tests"] == 0 && !item["certified"].get<bool>())
        text += line("no contact", "at any sampled pose: no proof that the bodies never meet");
    text += line("bounds", boundsText(item, metersPerUnit)) + exemptLine(item, metersPerUnit);
    if (item.contains("earlyContact")) text += earlyContactLines(item, metersPerUnit);
    return text;
}

/// A pair or a skin.
std::string itemLines(const Json& item, double metersPerUnit) {
    std::string text = item["path"].get<std::string>() + "\n";
    if (item.contains("joint")) text += line("joint", item["joint"].get<std::string>());
    for (const char* under : {"muscles", "bones"})
        if (!item.value(under, Json::array()).empty())
            text +=
                line(under, fmt::format("{}", fmt::join(item[under].get<std::vector<std::string>>(), ", ")));
    if (!item["baked"].get<bool>()) return text + "  not baked yet\n";
    if (const auto stale = item["stale"].get<std::string>(); !stale.empty())
        text += line("stale", stale + ": bake it again");
    if (item["spheresA"] != 0 || item["spheresB"] != 0)
        text += line("spheres", fmt::format("{} + {}", item["spheresA"].dump(), item["spheresB"].dump()));
    text +=
        item.value("neverCollides", false) ? proofLine(item, metersPerUnit) : tableLines(item, metersPerUnit);
    if (item.contains("kernel")) text += kernelLines(item["kernel"], metersPerUnit);
    const Json& seconds = item["seconds"];
    return text +
           line("made by",
                fmt::format("{}, {} bytes{}", item["method"].get<std::string>(), item["bytes"].dump(),
                            seconds.is_null() ? "" : fmt::format(", {:.2f} s", seconds.get<double>())));
}

} // namespace

std::string describe(const Json& summaryOfScene) {
    const double metersPerUnit = summaryOfScene["metersPerUnit"].get<double>();
    std::string text;
    for (const char* kind : {"pairs", "skins"})
        for (const Json& item : summaryOfScene[kind]) text += itemLines(item, metersPerUnit);
    return text.empty() ? "no pairs and no skins in this scene\n" : text;
}

} // namespace tss::tool
