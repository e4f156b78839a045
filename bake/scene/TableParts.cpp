#include "bake/base/NearestFloat.h"
#include "bake/scene/SceneParts.h"

#include <stdexcept>

namespace tss {

namespace {

constexpr Attribute widths = declared("float[] widths", "", atLeast(0));
constexpr Attribute purpose = declared("uniform token purpose");

/// A figure of both bodies, -1 where it is not known.
Field<BakeRecord> figure(std::string_view declaration, std::optional<double> FitRecord::*figure,
                         std::string_view meaning) {
    const auto read = [=](const PrimReader& prim, const Attribute& attribute, BakeRecord& record) {
        const std::vector<double> two = prim.reals(attribute, 2);
        if (two.size() != 2) return;
        if (two[0] >= 0) record.fitA.*figure = two[0];
        if (two[1] >= 0) record.fitB.*figure = two[1];
    };
    const auto write = [=](PrimWriter& prim, const Attribute& attribute, const BakeRecord& record) {
        const std::optional<double> a = record.fitA.*figure, b = record.fitB.*figure;
        prim.setIfAny(attribute,
                      a || b ? std::vector<double>{a.value_or(-1), b.value_or(-1)} : std::vector<double>());
    };
    return {declared(declaration, meaning), read, write};
}

} // namespace

const Fields<BakeRecord>& recordFields() {
    static const Fields<BakeRecord> fields{
        {declared("uniform uint64[] tss:generatedSpheres",
                  "spheres that either body was filled with, for readers; what is absent was not counted",
                  atLeast(0)),
         [](const PrimReader& prim, const Attribute& attribute, BakeRecord& record) {
             if (const auto two = prim.reals(attribute, 2); two.size() == 2)
                 record.spheresA = std::uint64_t(two[0]), record.spheresB = std::uint64_t(two[1]);
         },
         [](PrimWriter& prim, const Attribute& attribute, const BakeRecord& record) {
             const std::vector<double> two{double(record.spheresA), double(record.spheresB)};
             prim.setIfAny(attribute, record.spheresA || record.spheresB ? two : std::vector<double>());
         }},
        field("uniform uint64 tss:candidatePairs", &BakeRecord::candidatePairs, 0, anyNumber,
              "pairs of spheres that can meet"),
        field("uniform uint64 tss:lowerBound", &BakeRecord::lowerBound, 0, anyNumber,
              "no table with the same answers has fewer tests: the bake's word, no more than the tests"),
        figure("uniform double[] tss:coverage", &FitRecord::coverage,
               "of either body, a bound that the bake proved of all its spheres: how far the surface (of the "
               "contact zone, where spheres stand there alone) is outside of them; both together are no less "
               "than tss:boundMiss; -1: not known"),
        figure("uniform double[] tss:protrusion", &FitRecord::protrusion,
               "the same: how far the spheres stick out of the body; proven again of those that are stored"),
        figure("uniform double[] tss:coverageMean", &FitRecord::coverageMean, "its mean, sampled"),
        figure("uniform double[] tss:coverageP95", &FitRecord::coverageP95, "its 95th percentile"),
        figure("uniform double[] tss:protrusionMean", &FitRecord::protrusionMean, "its mean, sampled"),
        figure("uniform double[] tss:protrusionP95", &FitRecord::protrusionP95, "its 95th percentile"),
        figure("uniform double[] tss:volumeRatio", &FitRecord::volumeRatio,
               "the volume of the spheres' union beside the whole body's")};
    return fields;
}

SphereSet readSpheres(const SceneReading& reading, const PrimReader& table, const Attribute& relationship) {
    SphereSet spheres;
    const std::string path = table.target(relationship);
    const int entry = path.empty() ? -1 : reading.resolve(table, relationship, path);
    if (path.empty()) table.problem("expected the relationship ", relationship.name);
    if (entry < 0 || !reading.ownPrim(entry, "the spheres of a table")) return spheres;
    const PrimReader prim = reading.reader(entry);
    if (prim.prim().typeName != "Points") {
        table.targetProblem(relationship, "expected the path of Points, found \"", path, "\"");
        return spheres;
    }
    const auto centres = prim.vectors(schema::points);
    const auto diameters = prim.reals(widths, centres.size());
    if (diameters.size() != centres.size()) {
        if (!prim.has(widths)) prim.problem("expected the attribute widths: the spheres' diameters");
        return spheres;
    }
    for (std::size_t i = 0; i < centres.size(); ++i) spheres.push_back({centres[i], diameters[i] / 2});
    return spheres;
}

void writeSpheres(Layer& layer, const std::string& tablePath, const Attribute& relationship, const char* name,
                  const SphereSet& spheres) {
    PrimWriter table(*findPrim(layer, tablePath));
    const Property* old = table.prim().property(relationship.name);
    auto paths = old && old->isRelationship() ? listItems(*old->targetPaths) : std::vector<std::string>();
    if (paths.size() != 1) table.setTargets(relationship, paths = {tablePath + "/" + name});
    std::vector<Vec3> centres;
    std::vector<double> diameters;
    Eigen::AlignedBox3d box;
    for (const Sphere& sphere : spheres) {
        const Vec3& c = sphere.centre;
        if (!isFloat(c.x()) || !isFloat(c.y()) || !isFloat(c.z()) || !isFloat(2 * sphere.radius))
            throw std::logic_error(paths[0] +
                                   ": spheres of a table must be exact in float; use roundToFloat()");
        centres.push_back(c);
        diameters.push_back(2 * sphere.radius);
        for (double side : {-1.0, 1.0}) box.extend(Vec3(c + Vec3::Constant(side * sphere.radius)));
    }
    PrimWriter prim(makePrim(layer, paths[0], "Points"));
    prim.set(schema::points, centres);
    prim.set(widths, diameters);
    prim.set(purpose, Value("guide"));
    if (!spheres.empty()) prim.set(schema::extent, std::vector<Vec3>{box.min(), box.max()});
}

SchemaType sphereSchema() {
    return {"Points", {schema::points, widths, purpose}};
}

} // namespace tss
