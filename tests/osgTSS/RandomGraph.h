#pragma once
#include "Nodes.h"

#include <osg/LOD>
#include <osg/Switch>

#include <random>

namespace nodes {

/// A graph of DOFTransforms, limited and free, below scales, mirrors, LODs, switches, DYNAMIC nodes, with
/// geometry that several parents share.
class RandomGraph {
public:
    enum Kind {
        WIDE, ///< joints of up to six degrees of freedom, far apart
        TIGHT ///< of one, close to each other
    };

    explicit RandomGraph(unsigned seed, Kind kind = WIDE) : _kind(kind), _random(seed) {
        root->setName("Root");
        root->addChild(_shared);
        grow(*root, kind == TIGHT ? 2 : 3);
    }

    osg::ref_ptr<osg::Group> root = new osg::Group;

    /// Sets each degree of freedom of the joints that a visitor found to a random value within its limits,
    /// and returns them all.
    std::vector<double> set(const osgTSS::ConstraintVisitor& visitor, const tss::SceneModel& model) {
        std::vector<double> values;
        for (std::size_t j = 0; j < model.joints.size(); ++j) {
            auto& node = static_cast<osgSim::DOFTransform&>(*visitor.getJointNodes()[j]);
            osg::Vec3 hpr = node.getCurrentHPR(), slide = node.getCurrentTranslate();
            for (const tss::Dof& dof : model.joints[j].dofs) {
                const int axis = dof.name.back() - 'X', ofHpr[3] = {1, 2, 0};
                const bool turn = dof.kind == tss::DofKind::Rotation;
                float& value = turn ? hpr[ofHpr[axis]] : slide[axis];
                value = static_cast<float>(between(dof.lower, dof.upper));
                values.push_back(value);
            }
            node.setCurrentHPR(hpr);
            node.setCurrentTranslate(slide);
        }
        return values;
    }

    double between(double a, double b) { return std::uniform_real_distribution<double>(a, b)(_random); }

private:
    bool maybe(double chance) { return between(0, 1) < chance; }

    osg::Matrixd rigid() {
        const double far = _kind == TIGHT ? 1 : 5;
        return osg::Matrixd::rotate(between(-3, 3), osg::Vec3d(between(-1, 1), between(-1, 1), 1.5)) *
               osg::Matrixd::translate(between(-far, far), between(-far, far), between(-far, far));
    }

    osg::ref_ptr<osg::Group> between() {
        if (maybe(0.2)) return new osg::Switch;
        if (maybe(0.3)) {
            osg::ref_ptr<osg::LOD> lod = new osg::LOD;
            lod->setRange(0, 0, 100);
            return lod;
        }
        const double scale = maybe(0.5) ? 1 : between(_kind == TIGHT ? 0.5 : 0.1, 3) * (maybe(0.3) ? -1 : 1);
        osg::ref_ptr<osg::MatrixTransform> matrix =
            new osg::MatrixTransform(osg::Matrixd::scale(scale, scale, scale) * rigid());
        if (maybe(0.5)) matrix->setDataVariance(osg::Object::DYNAMIC);
        return matrix;
    }

    osg::ref_ptr<osgSim::DOFTransform> joint() {
        const auto node = _kind == TIGHT ? oneDof() : manyDofs();
        if (maybe(0.5)) {
            const osg::Matrixd put = rigid();
            node->setPutMatrix(put);
            node->setInversePutMatrix(osg::Matrixd::inverse(put));
        }
        if (maybe(0.3)) node->setCurrentScale(osg::Vec3(0.5f, 0.5f, 0.5f));
        return node;
    }

    /// A turn, with limits or without, or a slide.
    osg::ref_ptr<osgSim::DOFTransform> oneDof() {
        const unsigned int axis = _random() % 3, turnBit = axis == 0 ? 2 : axis - 1; // heading is about Z
        const bool turns = maybe(0.7), limited = !turns || maybe(0.6);
        const unsigned long flag = 0x80000000ul >> (3 + turnBit);
        const auto node = dof("Joint", limited ? allLimited : allLimited & ~flag);
        osg::Vec3 low, high;
        if (limited) low[axis] = -(high[axis] = float(between(0.3, 2)));
        turns ? node->setMinHPR(low) : node->setMinTranslate(low);
        turns ? node->setMaxHPR(high) : node->setMaxTranslate(high);
        return node;
    }

    osg::ref_ptr<osgSim::DOFTransform> manyDofs() {
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

    Kind _kind;
    std::mt19937_64 _random;
    osg::ref_ptr<osg::Node> _shared = box(osg::Vec3(1, 0, 0));
};

} // namespace nodes
