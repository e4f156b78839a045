#include "bake/usd/UsdSkel.h"

#include "bake/usd/UsdParts.h"
#include "bake/usd/UsdSkeleton.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace tss {

namespace {

constexpr Attribute skeletonOf{"skel:skeleton", "rel"}, animationOf{"skel:animationSource", "rel"};
constexpr const char *indicesOf = "primvars:skel:jointIndices", *weightsOf = "primvars:skel:jointWeights",
                     *bindOf = "primvars:skel:geomBindTransform";

/// An array of so many numbers a vertex, or once for all of them.
struct Influences {
    std::vector<double> numbers;
    std::size_t each = 1;
    bool constant = false;
};

Influences influencesOf(const PrimReader& prim, const char* name) {
    const Property& property = *prim.prim().property(name);
    Influences found;
    if (const Value* value = prim.value({name, property.typeName})) found.numbers = numbersIn(*value);
    if (const double* size = member<double>(property.other, "elementSize"))
        found.each = static_cast<std::size_t>(std::clamp(*size, 1.0, 1e6));
    const auto* interpolation = member<std::string>(property.other, "interpolation");
    found.constant = !interpolation || *interpolation == "constant";
    return found;
}

class SkelReader {
public:
    SkelReader(const SceneReading& reading, const SkelSurroundings& around, double start,
               std::set<std::string>& names, LeftOut& leftOut)
        : reading_(reading), around_(around), start_(start), names_(names), leftOut_(leftOut) {}

    UsdCharacters read() {
        const std::size_t count = reading_.index.entries.size();
        found_.skinned.assign(count, false);
        std::map<int, std::vector<std::size_t>> meshes; // by skeleton
        for (std::size_t i = 0; i < count; ++i) {
            if (const int skeleton = skeletonAbove(i); skeleton >= 0) meshes[skeleton].push_back(i);
            if (typeOf(i) == "Skeleton") meshes[static_cast<int>(i)];
            if (isGprim(prim(i)) && prim(i).property("skel:blendShapes"))
                leftOut_.add("left out: blend shapes, the mesh has the shape of its points", pathOf(i));
        }
        for (const auto& [skeleton, of] : meshes) readCharacter(skeleton, of);
        return std::move(found_);
    }

private:
    PrimReader reader(std::size_t entry) const { return reading_.reader(static_cast<int>(entry)); }
    const Prim& prim(std::size_t entry) const { return *reading_.index.entries[entry].prim; }
    const std::string& typeOf(std::size_t entry) const { return prim(entry).typeName; }
    const std::string& pathOf(std::size_t entry) const { return reading_.index.entries[entry].place.path; }

    /// The prim, or the nearest one above it, that has the property; -1: none has.
    int holding(std::size_t entry, std::string_view property) const {
        int at = static_cast<int>(entry);
        while (at >= 0 && !prim(at).property(property)) at = reading_.index.entries[at].parent;
        return at;
    }

    /// The entry that a binding above the prim names, of one of these types; -1: none.
    int boundTo(std::size_t entry, const Attribute& binding, const char* type) const {
        const int at = holding(entry, binding.name);
        if (at < 0) return -1;
        std::string why;
        try {
            const std::string path = reader(at).target(binding);
            if (path.empty()) return -1;
            const int found = reading_.index.find(path);
            if (found >= 0 && typeOf(found) == type) return found;
            why = "expected the path of a " + std::string(type) + ", found \"" + path + "\"";
        } catch (const InputError& error) {
            why = error.message;
        }
        leftOut_.add("left out: bindings of UsdSkel that lead nowhere",
                     pathOf(at) + "." + std::string(binding.name) + " (" + why + ")");
        return -1;
    }

    /// The skeleton that a mesh follows by its weights; -1 where it follows none.
    int skeletonAbove(std::size_t entry) const {
        if (!isGprim(prim(entry)) || holding(entry, indicesOf) < 0 || holding(entry, weightsOf) < 0)
            return -1;
        if (around_.linkOf[entry] >= 0) {
            leftOut_.add("left out: weights of meshes that are part of rigid bodies", pathOf(entry));
            return -1;
        }
        const int skeleton = boundTo(entry, skeletonOf, "Skeleton");
        if (skeleton < 0)
            leftOut_.add("left out: weights of meshes that are bound to no skeleton", pathOf(entry));
        return skeleton;
    }

    void readCharacter(std::size_t entry, const std::vector<std::size_t>& meshes) {
        if (meshes.empty()) return leftOut_.add("left out: skeletons that no mesh follows", pathOf(entry));
        try {
            if (!around_.unplaced[entry].empty()) throw InputError(around_.unplaced[entry]);
            const UsdSkeleton skeleton = readUsdSkeleton(reader(entry));
            Character character = characterOf(entry, skeleton);
            const Eigen::Affine3d toWorld = character.bones[0].bound * skeleton.bound[0].inverse();
            for (const std::size_t mesh : meshes) tryMesh(mesh, skeleton, toWorld, character);
            if (!character.meshes.empty()) found_.characters.push_back(std::move(character));
        } catch (const InputError& error) {
            leftOut_.add("left out: skeletons that cannot be read, so that their meshes stand still",
                         pathOf(entry) + " (" + messageBelow(pathOf(entry), error) + ")");
        }
    }

    /// As bound, the character is where its first joint rests.
    Character characterOf(std::size_t entry, const UsdSkeleton& skeleton) {
        Character character;
        character.name = pathOf(entry);
        const Eigen::Affine3d& world = around_.world[entry].matrix;
        const std::vector<Eigen::Affine3d> rest = skeleton.composed(skeleton.rest);
        const Eigen::Affine3d toWorld = world * rest[0] * skeleton.bound[0].inverse();
        for (std::size_t j = 0; j < skeleton.joints.size(); ++j)
            character.bones.push_back({freeName(pathOf(entry) + "/" + skeleton.joints[j], names_),
                                       skeleton.parents[j], toWorld * skeleton.bound[j], world * rest[j]});
        readAnimation(entry, skeleton, character);
        return character;
    }

    void readAnimation(std::size_t entry, const UsdSkeleton& skeleton, Character& character) const {
        const int source = boundTo(entry, animationOf, "SkelAnimation");
        if (source < 0)
            return leftOut_.add("skeletons without an animation: their joints have no range", pathOf(entry));
        try {
            const UsdAnimation animation(reader(source), skeleton);
            for (const std::string& joint : animation.unknown())
                leftOut_.add("left out: joints of animations that their skeleton does not have",
                             pathOf(source) + " (" + joint + ")");
            const PlacesAt placesAt = [&](double time) {
                std::vector<Eigen::Affine3d> places = skeleton.composed(animation.localAt(time));
                for (Eigen::Affine3d& place : places) place = around_.world[entry].matrix * place;
                return places;
            };
            std::vector<double> times = animation.times();
            if (times.empty()) times = {start_};
            character.runs.push_back(sampledRun(character, times, placesAt));
        } catch (const InputError& error) {
            leftOut_.add("left out: animations that cannot be read",
                         pathOf(source) + " (" + messageBelow(pathOf(source), error) + ")");
        }
    }

    void tryMesh(std::size_t entry, const UsdSkeleton& skeleton, const Eigen::Affine3d& toWorld,
                 Character& character) {
        try {
            Character::Mesh mesh;
            mesh.surface = meshOfGprim(reader(entry), toWorld * bindingPlace(entry));
            mesh.weights = weightsAt(entry, skeleton, mesh.surface.vertices.size());
            mesh.visible = reading_.index.entries[entry].visible;
            if (const auto colors = reader(entry).vectors(schema::displayColor); !colors.empty())
                mesh.color = colors.front().cwiseMax(0).cwiseMin(1);
            for (const Vec3& v : mesh.surface.vertices)
                if (!v.allFinite()) throw InputError("expected points that are finite");
            mesh.name = freeName(pathOf(entry), names_);
            character.meshes.push_back(std::move(mesh));
            found_.skinned[entry] = true;
        } catch (const InputError& error) {
            leftOut_.add("left out: weights that cannot be read, so that the mesh stands still",
                         pathOf(entry) + " (" + messageBelow(pathOf(entry), error) + ")");
        }
    }

    /// Where a mesh is when it is bound, which its own transform does not say.
    Eigen::Affine3d bindingPlace(std::size_t entry) const {
        const int at = holding(entry, bindOf);
        const Value* value = at < 0 ? nullptr : reader(at).value({bindOf, "matrix4d"});
        if (!value) return Eigen::Affine3d::Identity();
        const std::vector<double> numbers = numbersIn(*value);
        if (numbers.size() != 16) throw InputError(std::string(bindOf) + ": expected a matrix");
        return affineOf(numbers.data());
    }

    /// Of each joint that the mesh names, that of the skeleton.
    std::vector<int> jointsOf(std::size_t entry, const UsdSkeleton& skeleton) const {
        std::vector<int> joints;
        const int at = holding(entry, schema::skelJoints.name);
        const std::map<std::string, int> known = skeleton.indices();
        for (const std::string& joint : at < 0 ? skeleton.joints : reader(at).texts(schema::skelJoints)) {
            const auto found = known.find(joint);
            if (found == known.end())
                throw InputError("skel:joints: expected joints of the skeleton, found \"" + joint + "\"");
            joints.push_back(found->second);
        }
        return joints;
    }

    std::vector<std::vector<std::pair<int, double>>> weightsAt(std::size_t entry, const UsdSkeleton& skeleton,
                                                               std::size_t vertices) const {
        const std::vector<int> joints = jointsOf(entry, skeleton);
        const Influences indices = influencesOf(reader(holding(entry, indicesOf)), indicesOf),
                         weights = influencesOf(reader(holding(entry, weightsOf)), weightsOf);
        if (indices.each != weights.each || indices.constant != weights.constant)
            throw InputError(std::string(weightsOf) + ": expected the elementSize and interpolation of " +
                             indicesOf);
        const std::size_t wanted = indices.each * (indices.constant ? 1 : vertices);
        for (const auto& [name, found] : {std::pair(indicesOf, &indices), {weightsOf, &weights}})
            if (found->numbers.size() != wanted)
                throw InputError(joined(name, ": expected ", wanted, " numbers, ", indices.each,
                                        " (the elementSize) ",
                                        indices.constant ? "for all vertices (interpolation \"constant\")"
                                                         : joined("a vertex of ", vertices),
                                        ", found ", found->numbers.size()));
        std::vector<std::vector<std::pair<int, double>>> all(vertices);
        for (std::size_t v = 0; v < vertices; ++v)
            for (std::size_t k = 0; k < indices.each; ++k) {
                const std::size_t at = (indices.constant ? 0 : v * indices.each) + k;
                const double joint = indices.numbers[at], weight = weights.numbers[at];
                if (!(joint >= 0 && joint < static_cast<double>(joints.size())))
                    throw InputError(joined(indicesOf, ": expected indices from 0 to ", joints.size() - 1,
                                            ", found ", joint));
                if (weight > 0) all[v].emplace_back(joints[static_cast<std::size_t>(joint)], weight);
            }
        return all;
    }

    const SceneReading& reading_;
    const SkelSurroundings& around_;
    const double start_;
    std::set<std::string>& names_;
    LeftOut& leftOut_;
    UsdCharacters found_;
};

} // namespace

UsdCharacters readUsdSkel(const SceneReading& reading, const SkelSurroundings& around, double start,
                          std::set<std::string>& names, LeftOut& leftOut) {
    return SkelReader(reading, around, start, names, leftOut).read();
}

void addCharacters(const UsdCharacters& found, int world, bool saysEnd, Robot& robot, LeftOut& leftOut) {
    for (const Character& character : found.characters) {
        addCharacter(robot, character, world, leftOut);
        for (const Character::Run& run : character.runs)
            if (!saysEnd) robot.endTimeCode = std::max(robot.endTimeCode, run.times.back());
    }
}

bool isOfCharacters(const std::string& type) {
    return type == "SkelRoot" || type == "Skeleton" || type == "SkelAnimation" || type == "BlendShape";
}

} // namespace tss
