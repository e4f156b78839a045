#include "bake/report/Columns.h"

#include "bake/base/Degrees.h"
#include "bake/report/Text.h"

namespace tss::reporting {

namespace {

Json known(const std::optional<double>& value, double factor = 1) {
    return value ? Json(factor * *value) : Json(nullptr);
}

Json timeOf(double nanoseconds) {
    return nanoseconds > 0 ? Json(nanoseconds) : Json(nullptr);
}

std::string firstContactText(const PairStudy& study, const Row& row) {
    if (row.firstContact.motions == 0) return "–";
    if (row.firstContact.motions == row.firstContact.never) return "never";
    std::string text = number(study.millimetres * row.firstContact.worstLength) + " mm";
    if (study.leadingUnit == "degrees") text += ", " + number(toDegrees(row.firstContact.worstAngle)) + "°";
    if (row.firstContact.never)
        text += fmt::format(" ({} of {} never)", row.firstContact.never, row.firstContact.motions);
    return text;
}

/// What no reader is shown in a table.
void addFigures(Columns<Row>& columns, const std::string& json, ErrorFigures Row::*figures, double mm) {
    const auto add = [&](const char* name, auto value) {
        columns.push_back(
            {json + "/" + name, "", "", [=](const Row& row) { return Json(value(row.*figures)); }});
    };
    add("deepestMissMm", [mm](const ErrorFigures& f) { return f.deepestMiss * mm; });
    add("meanMissMm", [mm](const ErrorFigures& f) { return f.meanMiss * mm; });
    add("farthestEarlyMm", [mm](const ErrorFigures& f) { return f.farthestEarly * mm; });
    add("meanEarlyMm", [mm](const ErrorFigures& f) { return f.meanEarly * mm; });
    add("someMeasured", [](const ErrorFigures& f) { return f.sampled; });
}

} // namespace

std::string textOf(const Json& value) {
    if (value.is_null()) return "–";
    if (value.is_string()) return value.get<std::string>();
    return value.is_number_float() ? number(value.get<double>()) : value.dump();
}

std::vector<BakePoint> modelsOf(const PairStudy& study) {
    std::vector<BakePoint> models = study.tolerances;
    for (const BakePoint& point : study.epsilons)
        if (point.name != study.base.name) models.push_back(point);
    models.insert(models.end(), study.recipes.begin(), study.recipes.end());
    return models;
}

std::function<bool(const BakePoint&)> isBase(const PairStudy& study) {
    return [name = study.base.name](const BakePoint& point) { return point.name == name; };
}

Columns<Row> methodColumns(const PairStudy& study) {
    using R = const Row&;
    const double mm = study.millimetres;
    Columns<Row> columns{
        {"method", "method", "method", [](R r) { return r.method; }},
        {"setting", "setting", "spheres", [](R r) { return r.setting; }},
        {"family", "family", "", [](R r) { return r.about.family; }},
        {"about", "", "", [](R r) { return r.about.about; }},
        {"", "", "worst error, mm", [mm](R r) { return mm * r.worst(); }},
        {"times/medianNs", "nsMedian", "time a query (p10–p90)", [](R r) { return timeOf(r.times.median); },
         [](R r) { return timeText(r.times); }},
        {"times/p10Ns", "nsLow", "", [](R r) { return timeOf(r.times.low); }},
        {"times/p90Ns", "nsHigh", "", [](R r) { return timeOf(r.times.high); }},
        {"uniform/poses", "poses", "", [](R r) { return r.uniform.poses; }},
        {"uniform/touching", "touching", "", [](R r) { return r.uniform.touching; }},
        {"uniform/missed", "missed", "missed, uniform", [](R r) { return r.uniform.missed; },
         [](R r) { return shareText(r.uniform.missed, r.uniform.touching); }},
        {"nearContact/poses", "nearPoses", "", [](R r) { return r.near.poses; }},
        {"nearContact/touching", "nearTouching", "", [](R r) { return r.near.touching; }},
        {"nearContact/missed", "nearMissed", "missed, near contact", [](R r) { return r.near.missed; },
         [](R r) { return shareText(r.near.missed, r.near.touching); }},
        {"", "deepestMissMm", "deepest missed, mm", [mm](R r) { return mm * r.deepestMiss(); },
         [mm](R r) { return r.misses() ? number(mm * r.deepestMiss()) : ""; }},
        {"uniform/early", "early", "early, uniform", [](R r) { return r.uniform.early; },
         [](R r) { return shareText(r.uniform.early, r.uniform.poses - r.uniform.touching); }},
        {"nearContact/early", "nearEarly", "", [](R r) { return r.near.early; }},
        {"", "farthestEarlyMm", "farthest early, mm", [mm](R r) { return mm * r.farthestEarly(); },
         [mm](R r) { return r.uniform.early + r.near.early ? number(mm * r.farthestEarly()) : ""; }},
        {"statedMissMm", "statedMissMm", "promised: miss, mm",
         [mm](R r) { return known(r.about.stated.miss, mm); }},
        {"statedEarlyMm", "statedEarlyMm", "promised: early, mm",
         [mm](R r) { return known(r.about.stated.early, mm); }},
        {"firstContact/motions", "", "", [](R r) { return r.firstContact.motions; }},
        {"firstContact/never", "", "", [](R r) { return r.firstContact.never; }},
        {"firstContact/worstMm", "firstContactWorstMm", "first contact off by",
         [mm](R r) { return mm * r.firstContact.worstLength; },
         [study](R r) { return firstContactText(study, r); }},
        {"firstContact/earliestMm", "", "", [mm](R r) { return mm * r.firstContact.earliest; }},
        {"firstContact/latestMm", "", "", [mm](R r) { return mm * r.firstContact.latest; }},
        {"firstContact/worstOfLeadingDof", "", "", [](R r) { return r.firstContact.worstAngle; }},
        {"firstContact/meanOfLeadingDof", "", "", [](R r) { return r.firstContact.meanAngle; }},
        {"times/rounds", "", "", [](R r) { return r.times.rounds; }},
        {"times/queriesARound", "", "", [](R r) { return r.times.queries; }},
        {"tests", "tests", "tests", [](R r) { return known(r.tests); }},
        {"products", "products", "", [](R r) { return known(r.products); }},
        {"bytes", "bytes", "bytes", [](R r) { return r.about.bytes; },
         [](R r) { return bytesText(r.about.bytes); }},
        {"times/buildSeconds", "buildSeconds", "built in, s", [](R r) { return r.about.buildSeconds; }},
    };
    addFigures(columns, "uniform", &Row::uniform, mm);
    addFigures(columns, "nearContact", &Row::near, mm);
    return columns;
}

Columns<BakePoint> modelColumns(const PairStudy& study) {
    using P = const BakePoint&;
    const double mm = study.millimetres;
    return {
        {"name", "", "model", [](P p) { return p.name; }},
        {"about", "", "", [](P p) { return p.about; }},
        {"toleranceMm", "", "tolerance, mm", [mm](P p) { return p.tolerance * mm; }},
        {"epsilonMm", "", "ε, mm", [mm](P p) { return p.epsilon * mm; }},
        {"protrusionMm", "", "sticks out by, mm", [mm](P p) { return p.protrusion * mm; }},
        {"spheresA", "", "", [](P p) { return p.spheresA; }},
        {"spheresB", "", "", [](P p) { return p.spheresB; }},
        {"", "", "spheres", [](P p) { return p.spheresA + p.spheresB; },
         [](P p) { return fmt::format("{} + {}", p.spheresA, p.spheresB); }},
        {"usedA", "", "", [](P p) { return p.usedA; }},
        {"usedB", "", "", [](P p) { return p.usedB; }},
        {"", "", "used", [](P p) { return p.usedA + p.usedB; },
         [](P p) { return fmt::format("{} + {}", p.usedA, p.usedB); }},
        {"tests", "", "tests", [](P p) { return p.tests; }},
        {"restTests", "", "", [](P p) { return p.restTests; }},
        {"lowerBound", "", "lower bound", [](P p) { return known(p.lowerBound); }},
        {"certified", "", "", [](P p) { return p.certified; }},
        {"bytes", "", "bytes", [](P p) { return p.bytes; }, [](P p) { return bytesText(p.bytes); }},
        {"times/sphereSeconds", "", "spheres, s", [](P p) { return p.sphereSeconds; }},
        {"times/tableSeconds", "", "table, s", [](P p) { return p.tableSeconds; }},
    };
}

Columns<SamplingPoint> samplingColumns() {
    using P = const SamplingPoint&;
    return {
        {"samples", "", "poses explored", [](P p) { return p.samples; }},
        {"reduce", "", "reduction", [](P p) { return p.reduce; },
         [](P p) { return p.reduce == "none" ? "none" : "co-occurrence (the paper's)"; }},
        {"tests", "", "tests", [](P p) { return p.tests; }},
        {"missedUniform", "", "missed, uniform", [](P p) { return p.missedUniform; },
         [](P p) { return fmt::format("{:.3g} %", 100 * p.missedUniform); }},
        {"missedNearContact", "", "missed, near contact", [](P p) { return p.missedNear; },
         [](P p) { return fmt::format("{:.3g} %", 100 * p.missedNear); }},
        {"times/seconds", "", "table, s", [](P p) { return p.seconds; }},
    };
}

Columns<SkinMethod> methodColumns(const SkinStudy& study) {
    using M = const SkinMethod&;
    const double mm = study.millimetres;
    return {
        {"method", "method", "method", [](M m) { return m.name; }},
        {"", "family", "", [](M) { return "skin"; }},
        {"about", "", "", [](M m) { return m.about; }},
        {"", "poses", "", [study](M) { return study.judged; }},
        {"", "touching", "", [study](M) { return study.touching; }},
        {"tests", "tests", "tests a step", [](M m) { return m.tests; }},
        {"products", "products", "products a step", [](M m) { return m.products; }},
        {"times/medianNs", "nsMedian", "time a step", [](M m) { return timeOf(m.nanoseconds); },
         [](M m) { return m.nanoseconds > 0 ? timeText(m.nanoseconds) : "–"; }},
        {"missed", "missed", "missed", [](M m) { return m.missed; }},
        {"deepestMissMm", "deepestMissMm", "deepest missed, mm", [mm](M m) { return mm * m.deepestMiss; },
         [mm](M m) { return m.missed ? number(mm * m.deepestMiss) : ""; }},
        {"early", "early", "early", [](M m) { return m.early; }},
        {"farthestEarlyMm", "farthestEarlyMm", "farthest early, mm",
         [mm](M m) { return mm * m.farthestEarly; },
         [mm](M m) { return m.early ? number(mm * m.farthestEarly) : ""; }},
        {"testsAtEachActivation", "", "", [](M m) { return m.perStep; }},
    };
}

Columns<SkinAnswer> answerColumns(const SkinStudy& study) {
    using A = const SkinAnswer&;
    const double mm = study.millimetres;
    return {
        {"sweeps", "", "sweeps an update", [](A a) { return a.sweeps; },
         [](A a) {
             return a.sweeps == 0
                        ? std::string("none: spheres push spheres (the paper's way)")
                        : fmt::format("at most {}{}", a.sweeps, a.usual ? " (what applications get)" : "");
         }},
        {"usual", "", "", [](A a) { return a.usual; }},
        {"times/medianNs", "", "time an update", [](A a) { return timeOf(a.nanoseconds); },
         [](A a) { return a.nanoseconds > 0 ? timeText(a.nanoseconds) : "–"; }},
        {"deepestMm", "", "deepest left, mm", [mm](A a) { return mm * a.deepest; }},
        {"meanDepthMm", "", "mean of the steps, mm", [mm](A a) { return mm * a.meanDepth; }},
        {"farthestFromConvergedMm", "", "farthest from converged, mm", [mm](A a) { return mm * a.farthest; }},
        {"rmsFromConvergedMm", "", "rms from converged, mm", [mm](A a) { return mm * a.rms; }},
        {"areaChange", "", "area change", [](A a) { return a.areaChange; },
         [](A a) { return fmt::format("{:.2f} %", 100 * a.areaChange); }},
    };
}

} // namespace tss::reporting
