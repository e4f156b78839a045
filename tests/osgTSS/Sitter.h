#pragma once
#include "Rigged.h"

/// A figure that sits: a torso, a thigh to the front, and an arm above it of two parts, one rigged mesh. The
/// keys swing the arm down through the thigh and up again, and lift the thigh a little.
class Sitter : public Rigged {
public:
    static constexpr float shoulder = 1.0f, elbow = 0.7f, half = 0.1f;
    static constexpr double swing = 60, lift = 4, bend = 15; ///< of the keys, degrees

    /// matrices: keys of the arm are whole matrices this many degrees apart; 0: turns.
    explicit Sitter(double matrices = 0) {
        addBone("Torso", "", osg::Matrix());
        addBone("Thigh", "Torso", osg::Matrix::translate(0.2f, 0, 0));
        addBone("Upper", "Torso", osg::Matrix::translate(0.2f, 0, shoulder));
        addBone("Fore", "Upper", osg::Matrix::translate(elbow, 0, shoulder));
        addMesh();
        addKeys("Thigh", {turn(0), turn(-lift), turn(0)}, 2);
        if (matrices > 0) {
            std::vector<osg::Quat> turns;
            for (double at = -swing; at <= swing; at += matrices) turns.push_back(turn(swing - std::abs(at)));
            addMatrixKeys("Upper", turns, 2 * matrices / swing);
        } else {
            addKeys("Upper", {turn(0), turn(swing), turn(0)}, 2);
        }
        addKeys("Fore", {turn(-bend), turn(bend), turn(-bend)}, 2);
        manager->registerAnimation(animation);
    }

    void play() { manager->playAnimation(animation); }

    /// What is drawn of the vertices that a bone holds alone, in the skeleton.
    std::vector<osg::Vec3> drawn(const std::string& bone) const {
        std::vector<osg::Vec3> points;
        const auto& vertices = static_cast<const osg::Vec3Array&>(*rig->getVertexArray());
        for (const auto& [vertex, weight] : rig->getInfluenceMap()->at(bone))
            if (weight > 0.99f) points.push_back(vertices[vertex]);
        return points;
    }
    std::vector<osg::Vec3> drawn() const {
        const auto& vertices = static_cast<const osg::Vec3Array&>(*rig->getVertexArray());
        return {vertices.begin(), vertices.end()};
    }

    /// How deep what is drawn of the arm is in the thigh: below its upper side and above its lower one, over
    /// its length; 0 where it is beside it.
    double depth() const {
        const osg::Matrixd fromThigh = bones.at("Thigh")->getMatrixInSkeletonSpace();
        const osg::Matrixd toThigh = osg::Matrixd::inverse(fromThigh);
        double deepest = 0;
        for (const char* part : {"Upper", "Fore"})
            for (const osg::Vec3& point : drawn(part)) {
                const osg::Vec3d at = osg::Vec3d(point) * toThigh;
                if (at.x() < 0.05 || at.x() > 1.05 || at.z() < -half) continue;
                deepest = std::max(deepest, half - at.z());
            }
        return deepest;
    }

private:
    using Weights = std::vector<std::pair<std::string, float>>;

    /// A tube along x with square rings, closed at its ends. weights: of each ring.
    void addTube(const std::vector<float>& rings, float height, const std::vector<Weights>& weights) {
        auto& vertices = *_vertices;
        const auto first = static_cast<unsigned int>(vertices.size());
        for (std::size_t k = 0; k < rings.size(); ++k)
            for (const auto& [y, z] : {std::pair{-half, -half}, {half, -half}, {half, half}, {-half, half}}) {
                for (const auto& [bone, weight] : weights[k])
                    (*_influences)[bone].emplace_back(static_cast<unsigned int>(vertices.size()), weight);
                vertices.push_back(osg::Vec3(rings[k], y, height + z));
            }
        const auto quad = [&](unsigned int a, unsigned int b, unsigned int c, unsigned int d) {
            for (unsigned int v : {a, c, b, a, d, c}) _triangles->push_back(first + v);
        };
        for (unsigned int k = 0; k + 1 < rings.size(); ++k)
            for (unsigned int side = 0; side < 4; ++side) {
                const unsigned int next = (side + 1) % 4;
                quad(4 * k + next, 4 * k + side, 4 * k + 4 + side, 4 * k + 4 + next);
            }
        const auto last = static_cast<unsigned int>(4 * (rings.size() - 1));
        quad(0, 1, 2, 3);
        quad(last + 3, last + 2, last + 1, last);
    }

    void addMesh() {
        const Weights torso{{"Torso", 1.0f}}, thigh{{"Thigh", 1.0f}}, upper{{"Upper", 1.0f}},
            both{{"Upper", 0.55f}, {"Fore", 0.45f}}, fore{{"Fore", 1.0f}};
        addTube({-0.3f, 0.05f}, 0.5f, {torso, torso});
        addTube({0.3f, 0.6f, 0.9f, 1.2f}, 0, {thigh, thigh, thigh, thigh});
        addTube({0.25f, 0.4f, 0.55f, 0.7f, 0.85f, 1.0f, 1.15f, 1.35f}, shoulder,
                {upper, upper, upper, both, fore, fore, fore, fore});
        for (auto& [name, influence] : *_influences) influence.setName(name);
        osg::ref_ptr<osg::Geometry> source = new osg::Geometry;
        source->setVertexArray(_vertices);
        source->addPrimitiveSet(_triangles);
        rig->setSourceGeometry(source);
        rig->setInfluenceMap(_influences);
        osg::ref_ptr<osg::Geode> geode = new osg::Geode;
        geode->addDrawable(rig);
        skeleton->addChild(geode);
    }

    osg::ref_ptr<osg::Vec3Array> _vertices = new osg::Vec3Array;
    osg::ref_ptr<osg::DrawElementsUInt> _triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
    osg::ref_ptr<osgAnimation::VertexInfluenceMap> _influences = new osgAnimation::VertexInfluenceMap;
};
