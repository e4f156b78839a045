#pragma once
#include "bake/model/SceneModel.h"

#include <osg/Node>
#include <osgTSS/ConstraintVisitor>

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace osgTSS {

/// A pair where it stands in a graph: a model may fit several machines of one kind.
struct PairPlace {
    int pair = -1;                  ///< of the model
    std::vector<osg::Node*> joints; ///< in the order of the pair's
};

/// Finds the pairs of a model in a graph: what carries the joints' paths (JointTransforms, tags of earlier
/// installs), else what is named like them, each only where the table or proof fits what the graph holds
/// (whyUnfit()).
class Machines {
public:
    Machines(osg::Node& root, const tss::SceneModel& model);

    /// Every place of the pair; where there is none `why` says the reason. nameless: also of nodes without a
    /// name that are nothing yet that was tagged, as joints without names are numbered in the graph's order.
    std::vector<PairPlace> placesOf(int pair, std::string& why, bool nameless = false);

    /// Names the joints and the bodies of a place by the model's paths.
    void tag(const PairPlace& place);

    /// Warnings, a line each, of what the tables and proofs do not know in the graph: pairs whose joints are
    /// there but fit nowhere, and joints that the graph shows several times.
    std::vector<std::string> unknown();

private:
    /// The graph as a visitor finds it.
    struct Extraction {
        ConstraintVisitor visitor;
        const tss::SceneModel* found = nullptr;
    };

    const Extraction& extraction(bool activeOnly);
    std::vector<int> candidates(const Extraction& in, int joint, bool nameless) const;
    void extend(const Extraction& in, const tss::Pair& pair, bool nameless, std::vector<int>& chain,
                std::vector<std::vector<int>>& chains) const;
    std::string unfit(const Extraction& in, const tss::Pair& pair, const std::vector<int>& chain) const;

    osg::Node& _root;
    const tss::SceneModel& _model;
    std::unique_ptr<Extraction> _all, _active;
    std::map<std::string, std::vector<osg::Node*>> _tagged;
    std::map<std::string, int> _modelJoints;                   ///< by path
    std::map<const osg::Node*, std::set<std::string>> _placed; ///< paths of the joints that tag() named
};

} // namespace osgTSS
