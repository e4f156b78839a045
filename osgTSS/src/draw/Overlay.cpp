#include "BodyNodes.h"
#include "DrawnTable.h"
#include "osgTSS/src/EachNode.h"

#include <osg/NodeVisitor>
#include <osg/observer_ptr>
#include <osgTSS/Convert>
#include <osgTSS/Overlay>

#include "bake/geometry/PartSet.h"
#include "bake/model/UnderSkin.h"
#include "bake/motion/MuscleDeformer.h"
#include "bake/play/SkinSetup.h"

#include <cmath>

namespace osgTSS {

namespace {

const osg::Vec4 regionColor(0.3f, 0.9f, 0.4f, 0.6f);

/// Where a body stands now, in the overlay's frame; nothing when its node is gone.
std::optional<Similarity> placeNow(const BodyFrame& body, osg::Node& root, const osg::Matrixd& fromRoot) {
    const auto toRoot = body.node.valid() ? toAbove(root, *body.node) : std::nullopt;
    auto place = toRoot ? toSimilarity(*toRoot * fromRoot) : std::nullopt;
    if (place) place->scale /= body.scale;
    return place;
}

tss::Vec3 movedPoint(const tss::Vec3& point, const Similarity& to) {
    return to.pose * (to.scale * point);
}

tss::Sphere moved(const tss::Sphere& sphere, const Similarity& to) {
    return {movedPoint(sphere.centre, to), std::abs(to.scale) * sphere.radius};
}

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
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
            for (int k = 0; k < 3; ++k)
                lines->add(movedPoint(mesh.corner(t, k), to), movedPoint(mesh.corner(t, (k + 1) % 3), to));
    }
};

struct DrawnPair {
    DrawnTable table;
    DrawnRegion region;
    const tss::Table* source;
    BodyFrame bodyA, bodyB;

    void follow(osg::Node& root, const osg::Matrixd& fromRoot) {
        const auto nowA = placeNow(bodyA, root, fromRoot), nowB = placeNow(bodyB, root, fromRoot);
        if (!nowA || !nowB) return;
        for (std::size_t i = 0; i < table.a.size(); ++i) table.a[i] = moved(source->a[i], *nowA);
        for (std::size_t i = 0; i < table.b.size(); ++i) table.b[i] = moved(source->b[i], *nowB);
        table.draw();
        region.draw(*nowA, *nowB);
    }
};

/// A muscle or a bone below a skin.
struct DrawnUnder {
    BodyFrame body;
    std::shared_ptr<const tss::MuscleDeformer> shape; ///< in the skin's frame
    int muscle;                                       ///< whose activation it has; -1: none
    tss::Pose toBody;                                 ///< from the skin's frame, at rest
};

/// Skin spheres ride on vertices of the skin, muscle spheres on the muscle as it is shortened.
struct DrawnSkin {
    DrawnTable table;
    const tss::SkinTable* source;
    const tss::TriangleMesh* rest;
    BodyFrame body;
    osg::observer_ptr<SkinGeometry> shape;
    std::vector<DrawnUnder> under;
    std::vector<tss::MusclePoint> points; ///< one per muscle sphere

    void follow(const Scene& scene, double time, osg::Node& root, const osg::Matrixd& fromRoot) {
        const auto now = placeNow(body, root, fromRoot);
        if (!now || !shape.valid() || !shape->getVertices()) return;
        for (std::size_t i = 0; i < table.a.size(); ++i) {
            const std::uint32_t vertex = source->skinVertices[i];
            const tss::Vec3 strayed =
                toCore(osg::Vec3d((*shape->getVertices())[vertex])) - rest->vertices[vertex];
            table.a[i] = moved({source->table.a[i].centre + strayed, source->table.a[i].radius}, *now);
        }
        std::vector<tss::MuscleState> states;
        std::vector<std::optional<Similarity>> places;
        for (const DrawnUnder& of : under) {
            states.push_back(of.shape->state(of.muscle < 0 ? 0 : scene.getActivation(of.muscle, time)));
            places.push_back(placeNow(of.body, root, fromRoot));
        }
        for (std::size_t i = 0; i < table.b.size(); ++i) {
            const std::size_t m = source->muscleOf[i];
            if (!places[m]) continue;
            const double thickness = under[m].shape->thickness(points[i].s, states[m]);
            table.b[i] = moved({under[m].toBody * under[m].shape->map(points[i], states[m]),
                                source->table.b[i].radius * thickness},
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
        for (const tss::Pair& pair : model->pairs) {
            if (!pair.table) continue;
            const tss::Body &a = model->bodies[pair.bodyA], &b = model->bodies[pair.bodyB];
            pairs.push_back({DrawnTable(*pair.table),
                             {tss::meshOf(a.mesh, pair.table->restRegion.a),
                              tss::meshOf(b.mesh, pair.table->restRegion.b)},
                             pair.table.get(),
                             nodes.frame(a.path),
                             nodes.frame(b.path)});
        }
        for (const tss::SkinModel& skin : model->skins) addSkin(nodes, skin);
    }

    void addSkin(const BodyNodes& nodes, const tss::SkinModel& skin) {
        const tss::Body& body = model->bodies[skin.body];
        SkinGeometry* shape = nodes.shape(body.path);
        if (!skin.table || !shape) return;
        const tss::Table& table = skin.table->table;
        DrawnSkin drawn{
            DrawnTable(table), skin.table.get(), &body.mesh, nodes.frame(body.path), shape, {}, {}};
        const std::vector<tss::UnderSkin> under = tss::underSkin(*model, skin);
        const auto shapes = tss::skinMuscles(*model, skin);
        for (std::size_t k = 0; k < under.size() && under[k].body >= 0; ++k) {
            const tss::Body& of = model->bodies[under[k].body];
            drawn.under.push_back({nodes.frame(of.path), shapes[k], under[k].muscle,
                                   of.placement.inverse(Eigen::Isometry) * body.placement});
        }
        for (std::size_t i = 0; i < table.b.size(); ++i)
            drawn.points.push_back(shapes[skin.table->muscleOf[i]]->bind(table.b[i].centre));
        skins.push_back(std::move(drawn));
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
        const osg::Matrixd fromRoot = osg::Matrixd::inverse(*toAbove(root, *this));
        for (DrawnPair& pair : _drawing->pairs) pair.follow(root, fromRoot);
        if (const osg::FrameStamp* stamp = visitor.getFrameStamp())
            for (DrawnSkin& skin : _drawing->skins)
                skin.follow(*_scene, _scene->getClock().timeCode(*stamp), root, fromRoot);
    }
    osg::Group::traverse(visitor);
}

} // namespace osgTSS
