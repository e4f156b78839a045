#include "Heard.h"
#include "RandomGraph.h"

#include "bake/compare/MeshTruth.h"
#include "bake/model/Kinematics.h"
#include "bake/table/Query.h"

#include <osgTSS/Bake>

#include <memory>

using namespace osgTSS;
using namespace nodes;

namespace {

/// What tables and proofs of a graph say, against FCL where OSG draws the bodies.
class Judged {
public:
    explicit Judged(unsigned seed) : _graph(seed, RandomGraph::TIGHT) {
        const Heard quiet;
        _scene = bake(*_graph.root, BakeOptions("pairs=all tolerance=0.04 epsilon=0.04 budget=1 cache=off"));
        _visitor.setQuiet(true);
        _graph.root->accept(_visitor);
        _visitor.getModel(); // finishes it
        const tss::SceneModel& model = _scene->getModel();
        for (const tss::Pair& pair : model.pairs) {
            if (!pair.table && !pair.proof) continue;
            Pair made{&pair, nullptr, bodyNode(pair.bodyA), bodyNode(pair.bodyB), {}};
            made.truth = std::make_unique<tss::compare::MeshTruth>(model.bodies[pair.bodyA].mesh,
                                                                   model.bodies[pair.bodyB].mesh);
            if (!made.a.node || !made.b.node || made.truth->touches(stands(made))) continue; // excepted there
            for (const tss::JointDof& dof : tss::pairDofs(model, pair)) made.values.push_back(placeOf(dof));
            _pairs.push_back(std::move(made));
        }
    }

    void look() {
        const std::vector<double> values = _graph.set(_visitor, _visitor.getModel());
        for (const Pair& pair : _pairs) {
            const tss::Pose at = stands(pair);
            const bool meet = pair.truth->touches(at);
            ++poses;
            contacts += meet;
            if (pair.of->proof) {
                if (meet) FAIL(pair.of->path << " is proven never to meet, and does");
                continue;
            }
            std::vector<double> q;
            for (std::size_t place : pair.values) q.push_back(values[place]);
            const tss::Table& table = *pair.of->table;
            const double gap = tss::query(table, q).gap;
            reported += gap <= 0;
            if (meet && table.boundMiss && gap > *table.boundMiss + rounding)
                FAIL(pair.of->path << " meets at a gap of " << gap << ", misses at most "
                                   << *table.boundMiss);
            if (!meet && gap <= 0 && table.boundEarly) {
                const double distance = pair.truth->distance(at);
                if (distance > *table.boundEarly + rounding)
                    FAIL(pair.of->path << " is said to meet, " << distance << " apart, at most "
                                       << *table.boundEarly);
            }
        }
    }

    unsigned long poses = 0, contacts = 0, reported = 0;

private:
    static constexpr double rounding = 1e-6;

    struct Pair {
        const tss::Pair* of;
        std::unique_ptr<tss::compare::MeshTruth> truth;
        ConstraintVisitor::BodyNode a, b;
        std::vector<std::size_t> values; ///< of all joints', one a DOF of the pair
    };

    ConstraintVisitor::BodyNode bodyNode(int body) {
        const std::string& path = _scene->getModel().bodies[body].path;
        const auto& bodies = _visitor.getModel().bodies;
        for (std::size_t b = 0; b < bodies.size(); ++b)
            if (bodies[b].path == path) return _visitor.getBodyNodes()[b];
        return {};
    }

    std::size_t placeOf(const tss::JointDof& dof) {
        std::size_t first = 0;
        for (const tss::Joint& joint : _visitor.getModel().joints) {
            if (joint.path == _scene->getModel().joints[dof.joint].path) return first + dof.dof;
            first += joint.dofs.size();
        }
        throw std::logic_error("a joint that the graph does not have");
    }

    /// B against A, by the matrices of the graph alone.
    static tss::Pose stands(const Pair& pair) {
        const auto place = [](const ConstraintVisitor::BodyNode& body) {
            return toSimilarity(body.node->getWorldMatrices().at(0)).value();
        };
        auto a = place(pair.a), b = place(pair.b);
        const double lengths = a.scale / pair.a.scale; // of the world to those of the bodies
        a.pose.translation() /= lengths;
        b.pose.translation() /= lengths;
        return a.pose.inverse(Eigen::Isometry) * b.pose;
    }

    RandomGraph _graph;
    osg::ref_ptr<Scene> _scene;
    ConstraintVisitor _visitor{ConstraintVisitor::ALL};
    std::vector<Pair> _pairs;
};

void check(unsigned int first, unsigned int graphs, int settings) {
    unsigned long poses = 0, contacts = 0, reported = 0;
    for (unsigned int seed = first; seed < first + graphs; ++seed) {
        CAPTURE(seed);
        Judged judged(seed);
        for (int setting = 0; setting < settings; ++setting) judged.look();
        poses += judged.poses;
        contacts += judged.contacts;
        reported += judged.reported;
    }
    WARN(poses << " poses of pairs, in contact by FCL " << contacts << ", by tables " << reported);
    CHECK(poses > static_cast<unsigned long>(settings));
    CHECK(contacts > 0);
    CHECK(reported > 0);
}

} // namespace

TEST_CASE("tables and proofs of any graph say what FCL finds where OSG draws the bodies") {
    check(6, 3, 300);
}

TEST_CASE("tables and proofs of any graph say what FCL finds, in a million settings", "[.long]") {
    check(1, 200, 5000);
}
