// How often parts of a graph that somebody else made are in each other while it moves, with osgTSS and
// without it, by FCL on the very triangles; and what a frame costs. A row of a table of docs/OSG.md.
//   graph_contacts FILE ["OPTIONS" [FRAMES]]
// DOFTransforms go up and down within their limits, all at once and each at its own pace; the animations of
// osgAnimation play one after the other. Exit 1: something that does not rest in contact was in contact with
// osgTSS.
#include "bake/base/Error.h"
#include "bake/compare/MeshTruth.h"
#include "osgTSS/src/joints/DofState.h"

#include <osgAnimation/BasicAnimationManager>
#include <osgDB/ReadFile>
#include <osgSim/DOFTransform>
#include <osgTSS/Bake>
#include <osgTSS/ConstraintVisitor>
#include <osgTSS/Convert>
#include <osgTSS/Install>
#include <osgUtil/UpdateVisitor>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <map>
#include <memory>

namespace {

constexpr double framesPerSecond = 24;

class FindManagers : public osg::NodeVisitor {
public:
    FindManagers() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }
    void apply(osg::Node& node) override {
        for (osg::Callback* callback = node.getUpdateCallback(); callback;
             callback = callback->getNestedCallback())
            if (auto* manager = dynamic_cast<osgAnimation::BasicAnimationManager*>(callback))
                found.push_back(manager);
        traverse(node);
    }
    std::vector<osgAnimation::BasicAnimationManager*> found;
};

/// A graph that is played.
class Play {
public:
    Play(const std::string& file, const osgTSS::BakeOptions& options) : root(osgDB::readRefNodeFile(file)) {
        if (!root) throw tss::InputError(file + ": no plugin reads it");
        scene = osgTSS::bake(*root, options); // tags the graph as the options say
        visitor.setQuiet(true);
        visitor.setActiveOnly(options.activeOnly);
        root->accept(visitor);
        FindManagers managers;
        root->accept(managers);
        _managers = managers.found;
        _update->setFrameStamp(_stamp);
    }

    /// Returns the seconds of processor time that the update traversal takes.
    double frame(unsigned int number, unsigned int count) {
        drive(double(number) / count);
        animate(number, count);
        _stamp->setFrameNumber(number);
        _stamp->setSimulationTime(number / framesPerSecond);
        _stamp->setReferenceTime(number / framesPerSecond);
        _update->setTraversalNumber(number);
        const std::clock_t start = std::clock();
        root->accept(*_update);
        return double(std::clock() - start) / CLOCKS_PER_SEC;
    }

    /// Of a body to the world, in the body's lengths.
    tss::Pose poseOf(int body, double& scale) const {
        const auto& [node, own] = visitor.getBodyNodes()[static_cast<std::size_t>(body)];
        const osg::Matrixd matrix = node ? node->getWorldMatrices().at(0) : osg::Matrixd();
        const auto similarity = osgTSS::toSimilarity(matrix);
        if (!similarity) throw tss::InputError("a body is sheared");
        scale = similarity->scale / own;
        return similarity->pose;
    }

    osg::ref_ptr<osg::Node> root;
    osg::ref_ptr<osgTSS::Scene> scene;
    osgTSS::ConstraintVisitor visitor;

private:
    void drive(double share) {
        const tss::SceneModel& model = visitor.getModel();
        int which = 0;
        for (std::size_t j = 0; j < model.joints.size(); ++j) {
            auto* node = dynamic_cast<osgSim::DOFTransform*>(visitor.getJointNodes()[j]);
            if (!node) continue;
            const auto rounds = [&] { return 1 + std::fmod(0.618 * which++, 1.0) * 3; };
            osgTSS::swingDofs(*node, model.joints[j].dofs, rounds, share);
        }
    }

    void animate(unsigned int number, unsigned int count) {
        for (osgAnimation::BasicAnimationManager* manager : _managers) {
            const osgAnimation::AnimationList& list = manager->getAnimationList();
            if (list.empty()) continue;
            const std::size_t now = number * list.size() / count;
            if (number > 0 && (number - 1) * list.size() / count == now) continue;
            for (const auto& animation : list) manager->stopAnimation(animation);
            manager->playAnimation(list[now]);
        }
    }

    std::vector<osgAnimation::BasicAnimationManager*> _managers;
    osg::ref_ptr<osgUtil::UpdateVisitor> _update = new osgUtil::UpdateVisitor;
    osg::ref_ptr<osg::FrameStamp> _stamp = new osg::FrameStamp;
};

/// In how many frames the surfaces of each pair cross.
struct Counts {
    std::map<std::string, unsigned int> crossed; ///< pairs that do not where they rest
    unsigned int frames = 0;                     ///< of all pairs
    unsigned int resting = 0;                    ///< pairs that cross where they rest
    double milliseconds = 0;                     ///< of processor time an update traversal, mean ...
    double most = 0;                             ///< ... and the longest
};

Counts count(Play& play, const tss::SceneModel& baked, unsigned int frames) {
    struct Pair {
        const tss::Pair* pair;
        std::unique_ptr<tss::compare::MeshTruth> truth;
    };
    const tss::SceneModel& model = play.visitor.getModel();
    const auto bodyOf = [&](int body) {
        for (std::size_t b = 0; b < model.bodies.size(); ++b)
            if (model.bodies[b].path == baked.bodies[body].path) return static_cast<int>(b);
        throw tss::InputError("no body " + baked.bodies[body].path);
    };
    const auto crosses = [&](const Pair& pair) {
        double scaleA = 1, scaleB = 1;
        tss::Pose a = play.poseOf(bodyOf(pair.pair->bodyA), scaleA),
                  b = play.poseOf(bodyOf(pair.pair->bodyB), scaleB);
        a.translation() /= scaleA;
        b.translation() /= scaleA;
        return pair.truth->touches(a.inverse(Eigen::Isometry) * b);
    };
    Counts counts;
    std::vector<Pair> pairs;
    for (const tss::Pair& pair : baked.pairs) {
        if (!pair.table && !pair.proof) continue;
        Pair made{&pair, std::make_unique<tss::compare::MeshTruth>(baked.bodies[pair.bodyA].mesh,
                                                                   baked.bodies[pair.bodyB].mesh)};
        if (made.truth->touches(tss::pose(tss::pairMotion(baked, pair), [&] {
                std::vector<double> rest;
                for (const tss::Dof& dof : tss::pairMotion(baked, pair).dofs) rest.push_back(dof.rest);
                return rest;
            }())))
            ++counts.resting;
        else
            pairs.push_back(std::move(made));
    }
    for (unsigned int number = 0; number < frames; ++number) {
        const double milliseconds = 1000 * play.frame(number, frames);
        counts.milliseconds += milliseconds / frames;
        counts.most = std::max(counts.most, milliseconds);
        for (const Pair& pair : pairs)
            if (crosses(pair)) {
                ++counts.crossed[pair.pair->path];
                ++counts.frames;
            }
    }
    return counts;
}

int run(const std::string& file, const std::string& words, unsigned int frames) {
    const osgTSS::BakeOptions options(words);
    Play with(file, options), without(file, options);
    const tss::SceneModel& baked = with.scene->getModel();
    const osgTSS::Installed installed = osgTSS::install(*with.root, *with.scene);
    const Counts free = count(without, baked, frames), held = count(with, baked, frames);
    std::printf("| %s | `%s` | %zu | %u | %u | %u | %u | %u | %u | %.3g | %.3g | %.3g |\n",
                std::filesystem::path(file).filename().c_str(), words.c_str(), baked.pairs.size(),
                installed.joints, installed.proven, installed.unbaked, free.resting, free.frames, held.frames,
                free.milliseconds, held.milliseconds, held.most);
    for (const auto& [pair, times] : held.crossed)
        std::fprintf(stderr, "%s: in contact in %u of %u frames, %u without\n", pair.c_str(), times, frames,
                     free.crossed.contains(pair) ? free.crossed.at(pair) : 0);
    return held.frames > 0;
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 2 || argc > 4) {
        std::fprintf(stderr,
                     "usage: graph_contacts FILE [\"OPTIONS\" [FRAMES]]\n"
                     "| graph | options | pairs | tables | proofs | left out | in contact at rest | pairs "
                     "in contact, without | with | ms an update, without | with | at most |\n");
        return 2;
    }
    try {
        return run(argv[1], argc > 2 ? argv[2] : "",
                   argc > 3 ? static_cast<unsigned int>(std::stoul(argv[3])) : 200);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "graph_contacts: %s\n", error.what());
        return 3;
    }
}
