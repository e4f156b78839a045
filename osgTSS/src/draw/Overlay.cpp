#include "BodyNodes.h"
#include "SphereGeometry.h"
#include "osgTSS/src/EachNode.h"
#include "osgTSS/src/SceneCache.h"

#include <osg/BlendFunc>
#include <osg/LineWidth>
#include <osg/NodeVisitor>
#include <osg/Point>
#include <osg/observer_ptr>
#include <osgTSS/Convert>
#include <osgTSS/Overlay>

#include "bake/geometry/PartSet.h"

#include <cmath>
#include <limits>

namespace osgTSS {

namespace {

const osg::Vec4 colorA(0.25f, 0.55f, 0.95f, 0.35f), colorB(0.95f, 0.6f, 0.15f, 0.35f);
const osg::Vec4 pairColor(1, 1, 1, 0.25f), nearestColor(1, 0.15f, 0.15f, 1);
const osg::Vec4 regionColor(0.3f, 0.9f, 0.4f, 0.6f);

/// Lines of one colour, and points at their ends where wanted.
class Lines : public osg::Geometry {
public:
    Lines(const osg::Vec4& color, float width, bool points) : _points(points) {
        setDataVariance(DYNAMIC);
        setUseDisplayList(false);
        setUseVertexBufferObjects(true);
        setVertexArray(_vertices);
        osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array(osg::Array::BIND_OVERALL, 1);
        colors->front() = color;
        setColorArray(colors);
        osg::StateSet* state = getOrCreateStateSet();
        state->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
        // In front of everything: contact is where surfaces hide it.
        state->setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF);
        state->setAttributeAndModes(new osg::BlendFunc);
        state->setAttribute(new osg::LineWidth(width));
        state->setAttribute(new osg::Point(3 * width));
        state->setRenderBinDetails(20, "RenderBin");
    }

    void clear() { _vertices->clear(); }
    void add(const tss::Vec3& from, const tss::Vec3& to) {
        _vertices->push_back(osg::Vec3(toOsg(from)));
        _vertices->push_back(osg::Vec3(toOsg(to)));
    }
    void finish() {
        const auto count = static_cast<GLsizei>(_vertices->size());
        removePrimitiveSet(0, getNumPrimitiveSets());
        addPrimitiveSet(new osg::DrawArrays(GL_LINES, 0, count));
        if (_points && count > 0) addPrimitiveSet(new osg::DrawArrays(GL_POINTS, 0, 1));
        _vertices->dirty();
        dirtyGLObjects();
        dirtyBound();
    }

private:
    bool _points;
    osg::ref_ptr<osg::Vec3Array> _vertices = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX);
};

/// Where something of a body stands now, in the overlay's frame.
struct Carrier {
    osg::observer_ptr<osg::Node> node;
    double scale = 1;

    /// Nothing when the node is gone.
    std::optional<Similarity> now(osg::Node& root, const osg::Matrixd& fromRoot) const {
        if (!node.valid()) return std::nullopt;
        const osg::MatrixList matrices = node->getWorldMatrices(&root);
        if (matrices.empty()) return std::nullopt;
        auto place = toSimilarity(matrices.front() * fromRoot);
        if (place) place->scale /= scale;
        return place;
    }
};

tss::Sphere moved(const tss::Sphere& sphere, const Similarity& to) {
    return {to.pose * (to.scale * sphere.centre), std::abs(to.scale) * sphere.radius};
}

/// One table: where its spheres are is said anew each frame.
struct DrawnTable {
    std::vector<tss::SpherePair> tests;
    std::vector<double> restGaps;
    std::vector<tss::Sphere> a, b; ///< in the overlay's frame
    osg::ref_ptr<SphereGeometry> shapeA, shapeB;
    osg::ref_ptr<Lines> pairs = new Lines(pairColor, 1, false), nearest = new Lines(nearestColor, 3, true);

    explicit DrawnTable(const tss::Table& table)
        : tests(tss::tests(table)), restGaps(table.restGaps), a(table.a.size()), b(table.b.size()),
          shapeA(new SphereGeometry(table.a.size(), colorA)),
          shapeB(new SphereGeometry(table.b.size(), colorB)) {}

    void draw() {
        shapeA->place(a);
        shapeB->place(b);
        pairs->clear();
        nearest->clear();
        double least = std::numeric_limits<double>::infinity();
        const tss::SpherePair* closest = nullptr;
        for (std::size_t t = 0; t < tests.size(); ++t) {
            const tss::Sphere &from = a[tests[t].a], &to = b[tests[t].b];
            pairs->add(from.centre, to.centre);
            const double gap = (to.centre - from.centre).norm() - from.radius - to.radius -
                               (restGaps.empty() ? 0 : restGaps[t]);
            if (gap < least) {
                least = gap;
                closest = &tests[t];
            }
        }
        if (closest) drawContact(a[closest->a], b[closest->b]);
        pairs->finish();
        nearest->finish();
    }

private:
    /// The point between the two surfaces, and the normal there, as long as the smaller body is wide.
    void drawContact(const tss::Sphere& from, const tss::Sphere& to) {
        tss::Vec3 normal = to.centre - from.centre;
        const double distance = normal.norm();
        if (!(distance > 0)) return;
        normal /= distance;
        const tss::Vec3 point =
            from.centre + normal * (from.radius + (distance - from.radius - to.radius) / 2);
        Eigen::AlignedBox3d boxA, boxB;
        for (const tss::Sphere& sphere : a) boxA.extend(sphere.centre);
        for (const tss::Sphere& sphere : b) boxB.extend(sphere.centre);
        const double length = std::max(0.25 * std::min(boxA.diagonal().norm(), boxB.diagonal().norm()),
                                       4 * std::max(from.radius, to.radius));
        nearest->add(point, point + length * normal);
    }
};

/// The outlines of the parts of both surfaces that overlap at rest.
struct DrawnRegion {
    tss::TriangleMesh a, b;
    osg::ref_ptr<Lines> lines = new Lines(regionColor, 1, false);

    void draw(const Similarity& placeA, const Similarity& placeB) {
        if (a.empty() && b.empty()) return;
        lines->clear();
        add(a, placeA);
        add(b, placeB);
        lines->finish();
    }

private:
    void add(const tss::TriangleMesh& mesh, const Similarity& to) {
        const auto moved = [&](const tss::Vec3& x) -> tss::Vec3 { return to.pose * (to.scale * x); };
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
            for (int k = 0; k < 3; ++k)
                lines->add(moved(mesh.corner(t, k)), moved(mesh.corner(t, (k + 1) % 3)));
    }
};

struct DrawnPair {
    DrawnTable table;
    DrawnRegion region;
    const tss::Table* source;
    Carrier bodyA, bodyB;

    void follow(osg::Node& root, const osg::Matrixd& fromRoot) {
        const auto nowA = bodyA.now(root, fromRoot), nowB = bodyB.now(root, fromRoot);
        if (!nowA || !nowB) return;
        for (std::size_t i = 0; i < table.a.size(); ++i) table.a[i] = moved(source->a[i], *nowA);
        for (std::size_t i = 0; i < table.b.size(); ++i) table.b[i] = moved(source->b[i], *nowB);
        table.draw();
        region.draw(*nowA, *nowB);
    }
};

/// A bone as a muscle that does not contract.
std::shared_ptr<const tss::MuscleDeformer> bone(const tss::TriangleMesh& mesh) {
    tss::Muscle muscle;
    muscle.surface = mesh;
    muscle.maxContraction = 0;
    return std::make_shared<const tss::MuscleDeformer>(std::move(muscle));
}

/// Skin spheres ride on vertices of the skin, muscle spheres on the muscle as it is shortened.
struct DrawnSkin {
    struct Rider {
        const tss::MuscleDeformer* muscle;
        tss::MusclePoint point;
    };
    DrawnTable table;
    const tss::SkinTable* source;
    const tss::TriangleMesh* rest;
    Carrier body;
    std::vector<tss::UnderSkin> under; ///< the muscles and bones below the skin
    std::vector<Carrier> muscleBodies; ///< one each
    std::vector<std::shared_ptr<const tss::MuscleDeformer>> muscles;
    std::vector<Rider> riders; ///< one per muscle sphere
    osg::observer_ptr<SkinGeometry> shape;

    void follow(const Scene& scene, double time, osg::Node& root, const osg::Matrixd& fromRoot) {
        const auto now = body.now(root, fromRoot);
        if (!now || !shape.valid() || !shape->getVertices()) return;
        for (std::size_t i = 0; i < table.a.size(); ++i) {
            const std::uint32_t vertex = source->skinVertices[i];
            const tss::Vec3 strayed =
                toCore(osg::Vec3d((*shape->getVertices())[vertex])) - rest->vertices[vertex];
            table.a[i] = moved({source->table.a[i].centre + strayed, source->table.a[i].radius}, *now);
        }
        std::vector<tss::MuscleState> states;
        std::vector<std::optional<Similarity>> places;
        for (std::size_t m = 0; m < muscles.size(); ++m) {
            const int muscle = under[m].muscle;
            states.push_back(muscles[m]->state(muscle < 0 ? 0 : scene.getActivation(muscle, time)));
            places.push_back(muscleBodies[m].now(root, fromRoot));
        }
        for (std::size_t i = 0; i < table.b.size(); ++i) {
            const std::size_t m = source->muscleOf[i];
            if (!places[m]) continue;
            const Rider& rider = riders[i];
            const double thickness = rider.muscle->thickness(rider.point.s, states[m]);
            table.b[i] =
                moved({rider.muscle->map(rider.point, states[m]), source->table.b[i].radius * thickness},
                      *places[m]);
        }
        table.draw();
    }
};

} // namespace

struct Overlay::Drawing {
    std::shared_ptr<const tss::SceneModel> model;
    std::vector<DrawnPair> pairs;
    std::vector<DrawnSkin> skins;
    unsigned int traversal = 0;
    bool drawn = false;

    Drawing(osg::Node& root, const Scene& scene) : model(scene.shareModel()) {
        const BodyNodes nodes = findBodyNodes(root);
        const auto carrier = [&](int body) {
            const auto found = nodes.frames.find(model->bodies[body].path);
            return found == nodes.frames.end() ? Carrier{} : Carrier{found->second.node, found->second.scale};
        };
        for (const tss::Pair& pair : model->pairs)
            if (pair.table)
                pairs.push_back({DrawnTable(*pair.table),
                                 {tss::meshOf(model->bodies[pair.bodyA].mesh, pair.table->restRegion.a),
                                  tss::meshOf(model->bodies[pair.bodyB].mesh, pair.table->restRegion.b)},
                                 pair.table.get(),
                                 carrier(pair.bodyA),
                                 carrier(pair.bodyB)});
        for (const tss::SkinModel& skin : model->skins) {
            const auto shape = nodes.shapes.find(model->bodies[skin.body].path);
            if (!skin.table || shape == nodes.shapes.end()) continue;
            DrawnSkin drawn{DrawnTable(skin.table->table),
                            skin.table.get(),
                            &model->bodies[skin.body].mesh,
                            carrier(skin.body),
                            {},
                            {},
                            {},
                            {},
                            shape->second};
            const tss::Pose& skinPlace = model->bodies[skin.body].placement;
            std::vector<tss::Pose> toMuscle;
            drawn.under = tss::underSkin(*model, skin);
            std::erase_if(drawn.under, [](const tss::UnderSkin& under) { return under.body < 0; });
            for (const tss::UnderSkin& under : drawn.under) {
                drawn.muscleBodies.push_back(carrier(under.body));
                drawn.muscles.push_back(under.muscle >= 0 ? scene.getCache().muscle(under.muscle)
                                                          : bone(model->bodies[under.body].mesh));
                toMuscle.push_back(model->bodies[under.body].placement.inverse(Eigen::Isometry) * skinPlace);
            }
            for (std::size_t i = 0; i < skin.table->table.b.size(); ++i) {
                const std::size_t m = skin.table->muscleOf[i];
                drawn.riders.push_back({drawn.muscles[m].get(),
                                        drawn.muscles[m]->bind(toMuscle[m] * skin.table->table.b[i].centre)});
            }
            skins.push_back(std::move(drawn));
        }
    }

    template <class Each>
    void each(const Each& each) {
        for (DrawnPair& pair : pairs) each(pair.table);
        for (DrawnSkin& skin : skins) each(skin.table);
    }
};

Overlay::Overlay() {
    setName("Overlay");
    setDataVariance(DYNAMIC);
    setCullingActive(false);
    setShown(false);
}

Overlay::Overlay(Scene* scene) : Overlay() {
    _scene = scene;
}

// Its children are made from the graph it hangs in.
Overlay::Overlay(const Overlay& other, const osg::CopyOp&) : Overlay() {
    setName(other.getName());
    setNodeMask(other.getNodeMask());
    _scene = other._scene;
}

Overlay::~Overlay() = default;

void Overlay::setScene(Scene* scene) {
    _scene = scene;
    _drawing = nullptr;
}

Overlay* Overlay::find(osg::Node& root) {
    Overlay* found = nullptr;
    eachNode(root, [&](osg::Node& node) {
        if (!found) found = dynamic_cast<Overlay*>(&node);
    });
    return found;
}

// At the cull: update callbacks of the nodes above run after those of their children, and all of them are
// through now.
void Overlay::traverse(osg::NodeVisitor& visitor) {
    if (visitor.getVisitorType() != osg::NodeVisitor::CULL_VISITOR || !_scene || getNumParents() == 0)
        return osg::Group::traverse(visitor);
    const OpenThreads::ScopedLock<OpenThreads::Mutex> lock(_mutex);
    osg::Node& root = *getParent(0);
    if (!_drawing || _drawing->model != _scene->shareModel()) {
        removeChildren(0, getNumChildren());
        _drawing = std::make_unique<Drawing>(root, *_scene);
        for (DrawnPair& pair : _drawing->pairs) addChild(pair.region.lines);
        _drawing->each([&](DrawnTable& table) {
            addChild(table.shapeA);
            addChild(table.shapeB);
            addChild(table.pairs);
            addChild(table.nearest);
        });
    }
    if (!_drawing->drawn || _drawing->traversal != visitor.getTraversalNumber()) {
        _drawing->drawn = true;
        _drawing->traversal = visitor.getTraversalNumber();
        const osg::MatrixList own = getWorldMatrices(&root);
        const osg::Matrixd fromRoot = own.empty() ? osg::Matrixd() : osg::Matrixd::inverse(own.front());
        for (DrawnPair& pair : _drawing->pairs) pair.follow(root, fromRoot);
        if (const osg::FrameStamp* stamp = visitor.getFrameStamp())
            for (DrawnSkin& skin : _drawing->skins)
                skin.follow(*_scene, _scene->getClock().timeCode(*stamp), root, fromRoot);
    }
    osg::Group::traverse(visitor);
}

} // namespace osgTSS
