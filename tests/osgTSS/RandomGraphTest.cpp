#include "Nodes.h"

#include "bake/model/Kinematics.h"

#include <osg/LOD>
#include <osg/Notify>
#include <osg/Switch>

#include <random>

using namespace osgTSS;
using namespace nodes;

namespace {

/// A graph of DOFTransforms, limited and free, below scales, mirrors, LODs, switches, DYNAMIC nodes, with
/// geometry that several parents share.
class RandomGraph {
public:
    explicit RandomGraph(unsigned seed) : _random(seed) {
        root->setName("Root");
        root->addChild(_shared);
        grow(*root, 3);
    }

    osg::ref_ptr<osg::Group> root = new osg::Group;

    double between(double a, double b) { return std::uniform_real_distribution<double>(a, b)(_random); }

private:
    bool maybe(double chance) { return between(0, 1) < chance; }

    osg::Matrixd rigid() {
        return osg::Matrixd::rotate(between(-3, 3), osg::Vec3d(between(-1, 1), between(-1, 1), 1.5)) *
               osg::Matrixd::translate(between(-5, 5), between(-5, 5), between(-5, 5));
    }

    osg::ref_ptr<osg::Group> between() {
        if (maybe(0.2)) return new osg::Switch;
        if (maybe(0.3)) {
            osg::ref_ptr<osg::LOD> lod = new osg::LOD;
            lod->setRange(0, 0, 100);
            return lod;
        }
        const double scale = maybe(0.5) ? 1 : between(0.1, 3) * (maybe(0.3) ? -1 : 1);
        osg::ref_ptr<osg::MatrixTransform> matrix =
            new osg::MatrixTransform(osg::Matrixd::scale(scale, scale, scale) * rigid());
        if (maybe(0.5)) matrix->setDataVariance(osg::Object::DYNAMIC);
        return matrix;
    }

    osg::ref_ptr<osgSim::DOFTransform> joint() {
        const auto node = dof("Joint", maybe(0.3) ? allLimited : maybe(0.5) ? 0ul : _random() & allLimited);
        node->setHPRMultOrder(static_cast<osgSim::DOFTransform::MultOrder>(_random() % 6));
        osg::Vec3 low, high, slideLow, slideHigh;
        for (int i = 0; i < 3; ++i) {
            if (maybe(0.5)) low[i] = -(high[i] = float(between(0, 2)));
            if (maybe(0.5)) slideLow[i] = -(slideHigh[i] = float(between(0, 3)));
        }
        node->setMinHPR(low);
        node->setMaxHPR(high);
        node->setMinTranslate(slideLow);
        node->setMaxTranslate(slideHigh);
        if (maybe(0.5)) {
            const osg::Matrixd put = rigid();
            node->setPutMatrix(put);
            node->setInversePutMatrix(osg::Matrixd::inverse(put));
        }
        if (maybe(0.3)) node->setCurrentScale(osg::Vec3(0.5f, 0.5f, 0.5f));
        return node;
    }

    void grow(osg::Group& parent, int depth) {
        for (int child = 0; child < 2; ++child) {
            osg::ref_ptr<osg::Group> above = &parent;
            for (int k = 0; k < 2 && maybe(0.6); ++k) {
                const osg::ref_ptr<osg::Group> next = between();
                above->addChild(next);
                above = next;
            }
            const auto node = joint();
            above->addChild(node);
            node->addChild(_shared);
            if (depth > 1 && maybe(0.6)) grow(*node, depth - 1);
        }
    }

    std::mt19937_64 _random;
    osg::ref_ptr<osg::Node> _shared = box(osg::Vec3(1, 0, 0));
};

/// The largest difference between where the model's joints and OSG put points of the bodies, over so many
/// settings, as a share of the graph's size.
double worstOf(unsigned seed, int settings, int& joints) {
    RandomGraph graph(seed);
    ConstraintVisitor visitor;
    visitor.setQuiet(true);
    graph.root->accept(visitor);
    const tss::SceneModel& model = visitor.getModel();
    joints += static_cast<int>(model.joints.size());
    double worst = 0;
    for (int setting = 0; setting < settings; ++setting) {
        std::vector<double> values;
        for (std::size_t j = 0; j < model.joints.size(); ++j) {
            auto& node = static_cast<osgSim::DOFTransform&>(*visitor.getJointNodes()[j]);
            osg::Vec3 hpr = node.getCurrentHPR(), slide = node.getCurrentTranslate();
            for (const tss::Dof& dof : model.joints[j].dofs) {
                const int axis = dof.name.back() - 'X', ofHpr[3] = {1, 2, 0};
                const bool turn = dof.kind == tss::DofKind::Rotation;
                float& value = turn ? hpr[ofHpr[axis]] : slide[axis];
                value = static_cast<float>(graph.between(dof.lower, dof.upper));
                values.push_back(value);
            }
            node.setCurrentHPR(hpr);
            node.setCurrentTranslate(slide);
        }
        const std::vector<tss::Pose> poses = tss::posedBodies(model, values);
        for (std::size_t b = 0; b < poses.size(); ++b) {
            const auto& [node, scale] = visitor.getBodyNodes()[b];
            if (!node) continue;
            for (const osg::Vec3d& point : {osg::Vec3d(), osg::Vec3d(1, 2, 3)}) {
                const osg::Vec3d theirs = toWorld(*node, point);
                const osg::Vec3d ours = toOsg(tss::Vec3(poses[b] * (scale * toCore(point))));
                worst = std::max(worst, (ours - theirs).length() / (1 + theirs.length()));
            }
        }
    }
    return worst;
}

void check(int graphs, int settings) {
    int joints = 0;
    for (int seed = 1; seed <= graphs; ++seed) {
        const double worst = worstOf(static_cast<unsigned>(seed), settings, joints);
        CAPTURE(seed, worst);
        REQUIRE(worst < 1e-9);
    }
    CHECK(joints > 2 * graphs);
}

} // namespace

TEST_CASE("joints of any graph of DOFTransforms stand as OSG puts them") {
    check(100, 20);
}

TEST_CASE("joints of any graph of DOFTransforms stand as OSG puts them, in a million settings", "[.long]") {
    check(2000, 500);
}
