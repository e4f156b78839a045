#include "bake/motion/MuscleRing.h"
#include "bake/scene/SceneParts.h"

namespace tss {

namespace {

constexpr Attribute surface = declared("rel tss:surface", "its mesh");
constexpr Attribute origin = declared("uniform point3f tss:origin", "where it begins; not of a ring");
constexpr Attribute insertion = declared("uniform point3f tss:insertion", "where it ends; not of a ring");
constexpr Attribute fibre =
    declared("uniform point3f[] tss:fibre",
             "the points between them (optional); of a ring the closed line, once round");
constexpr Attribute form =
    declared("uniform token tss:form",
             "how it thickens: about its line, about its medial surface, about a closed line", anyNumber,
             "tube sheet ring");
constexpr Attribute activationRange =
    declared("uniform double2 tss:activationRange", "activations that it is baked for (0 to 1)");
constexpr Attribute activation = declared("double tss:activation", "the desired one, usually time samples");

const Fields<Muscle>& muscleFields() {
    static const Fields<Muscle> fields{
        surface,
        schema::bone,
        schema::originBone,
        schema::insertionBone,
        {form, nullptr,
         [](PrimWriter& prim, const Attribute&, const Muscle& muscle) {
             const char* const words[] = {"tube", "sheet", "ring"};
             prim.setUnless(form, words[static_cast<int>(muscle.form)], words[0]);
         }},
        origin,
        insertion,
        fibre,
        field("uniform double tss:anchor", &Muscle::anchor, 0, between(0, 1),
              "what stays where it is, from 0 at the origin (0) to 1"),
        field("uniform double tss:maxContraction", &Muscle::maxContraction, 0.2, between(0, 1),
              "greatest shortening, as a part of its length (0.2)"),
        {activationRange,
         [](const PrimReader& prim, const Attribute&, Muscle& muscle) {
             const auto range = prim.reals(activationRange, 2);
             if (range.size() == 2 && range[0] > range[1])
                 prim.problem(activationRange, "expected the lower activation first");
             else if (range.size() == 2)
                 muscle.activationLower = range[0], muscle.activationUpper = range[1];
         },
         [](PrimWriter& prim, const Attribute&, const Muscle& muscle) {
             if (muscle.activationLower != 0 || muscle.activationUpper != 1)
                 prim.set(activationRange, std::vector{muscle.activationLower, muscle.activationUpper});
         }},
        activation};
    return fields;
}

int readSurface(const SceneReading& reading, const PrimReader& prim) {
    const std::string path = prim.target(surface);
    const int body = reading.body(prim, surface, path);
    if (path.empty())
        prim.problem("expected a relationship tss:surface that names the muscle's mesh");
    else if (body >= 0 && reading.scene.bodies[body].mesh.empty())
        prim.targetProblem(surface, "expected a mesh with faces, found \"", path, "\"");
    return body;
}

/// One bone, or one at either end.
void readBones(const SceneReading& reading, const PrimReader& prim, MuscleModel& model) {
    const std::string one = prim.target(schema::bone), from = prim.target(schema::originBone),
                      to = prim.target(schema::insertionBone);
    if (!one.empty() && !(from.empty() && to.empty()))
        prim.problem("expected either tss:bone or tss:originBone and tss:insertionBone, found both");
    model.bone =
        one.empty() ? reading.body(prim, schema::originBone, from) : reading.body(prim, schema::bone, one);
    model.insertionBone = reading.body(prim, schema::insertionBone, to);
    if (model.insertionBone == model.bone) model.insertionBone = -1;
    model.muscle.spans = model.insertionBone >= 0;
}

/// By the names that the prim has for them already.
void writeBones(PrimWriter& prim, const SceneModel& scene, const MuscleModel& model) {
    const bool hasInsertion = prim.prim().property(schema::insertionBone.name);
    const bool both =
        model.insertionBone >= 0 || hasInsertion || prim.prim().property(schema::originBone.name);
    const int last = model.insertionBone < 0 && hasInsertion ? model.bone : model.insertionBone;
    for (const Attribute& name : {schema::bone, schema::originBone, schema::insertionBone}) prim.remove(name);
    if (model.bone >= 0)
        prim.setTargets(both ? schema::originBone : schema::bone, pathsOf(scene.bodies, {model.bone}));
    if (last >= 0) prim.setTargets(schema::insertionBone, pathsOf(scene.bodies, {last}));
}

/// Its line from origin to insertion; of a ring, which is closed, once round.
std::vector<Vec3> readLine(const PrimReader& prim, bool ring) {
    for (const Attribute& end : {origin, insertion})
        if (ring && prim.value(end))
            prim.problem(end, "expected none: a ring of muscle has no ends");
        else if (!ring && !prim.value(end))
            prim.problem("expected the attribute ", end.name, " (point3f)");
    if (!ring) {
        std::vector<Vec3> line{prim.vector(origin, Vec3::Zero())};
        for (const Vec3& point : prim.vectors(fibre)) line.push_back(point);
        line.push_back(prim.vector(insertion, Vec3::UnitX()));
        if (line.front() == line.back()) prim.problem(insertion, "expected another point than tss:origin");
        return line;
    }
    auto line = prim.vectors(fibre);
    try {
        MuscleRing{line};
    } catch (const InputError& e) {
        prim.problem(fibre, "expected the ring's line, once round: ", e.what());
        line = {Vec3::UnitX(), Vec3::UnitY(), -Vec3::UnitX() - Vec3::UnitY()};
    }
    return line;
}

void writeLine(PrimWriter& prim, const Muscle& muscle) {
    const auto& line = muscle.fibre;
    if (muscle.form == MuscleForm::Ring) return prim.set(fibre, line);
    prim.set(origin, line.at(0));
    prim.set(insertion, line.back());
    if (line.size() > 2) prim.set(fibre, std::vector<Vec3>(line.begin() + 1, line.end() - 1));
}

} // namespace

std::vector<SchemaType> muscleSchemas() {
    return {muscleFields().schema("TssMuscle")};
}

void readMuscles(SceneReading& reading) {
    const auto isMuscle = [](const Prim& prim) { return prim.typeName == "TssMuscle"; };
    reading.forPrims(isMuscle, [&](const PrimReader& prim, int) {
        MuscleModel model;
        model.path = prim.place().path;
        model.body = readSurface(reading, prim);
        readBones(reading, prim, model);
        Muscle& muscle = model.muscle;
        const std::string word = prim.choice(form);
        muscle.form = word == "ring"    ? MuscleForm::Ring
                      : word == "sheet" ? MuscleForm::Sheet
                                        : MuscleForm::Tube;
        muscle.fibre = readLine(prim, muscle.form == MuscleForm::Ring);
        muscleFields().read(prim, muscle);
        model.activation = prim.samples(activation);
        if (model.body < 0) return;
        muscle.surface = reading.scene.bodies[model.body].mesh;
        for (Vec3& point : muscle.fibre) point = stretched(reading.bodyXforms[model.body], point);
        reading.muscleAt[model.path] = static_cast<int>(reading.scene.muscles.size());
        reading.scene.muscles.push_back(std::move(model));
    });
}

void writeMuscles(Layer& layer, const SceneModel& scene) {
    for (const MuscleModel& model : scene.muscles) {
        PrimWriter prim(makePrim(layer, model.path, "TssMuscle"));
        prim.setTargets(surface, pathsOf(scene.bodies, {model.body}));
        writeBones(prim, scene, model);
        writeLine(prim, model.muscle);
        muscleFields().write(prim, model.muscle);
        prim.set(activation, model.activation);
    }
}

} // namespace tss
