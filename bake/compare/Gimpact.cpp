#include "bake/base/Stopwatch.h"
#include "bake/compare/Methods.h"

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

namespace tss::compare {

namespace {

/// A body as Bullet wants it. Bullet's own thresholds are made for things about a unit in size, so both
/// bodies are scaled to that and set about a common centre.
struct GimpactBody {
    GimpactBody(const TriangleMesh& mesh, const Vec3& centre, double scale) {
        for (const Vec3& v : mesh.vertices)
            for (int k = 0; k < 3; ++k) points.push_back(static_cast<btScalar>((v[k] - centre[k]) * scale));
        for (const Tri& t : mesh.triangles) indices.insert(indices.end(), {t[0], t[1], t[2]});
        array = std::make_unique<btTriangleIndexVertexArray>(
            static_cast<int>(mesh.triangles.size()), indices.data(), static_cast<int>(3 * sizeof(int)),
            static_cast<int>(mesh.vertices.size()), points.data(), static_cast<int>(3 * sizeof(btScalar)));
        shape = std::make_unique<btGImpactMeshShape>(array.get());
        shape->setMargin(0);
        shape->updateBound();
        object.setCollisionShape(shape.get());
    }
    std::size_t bytes() const { // and one node of the quantised tree for each leaf and inner node
        return points.size() * sizeof(btScalar) + indices.size() * sizeof(int) +
               2 * (indices.size() / 3) * sizeof(BT_QUANTIZED_BVH_NODE);
    }

    btCollisionObjectWrapper wrapped() const {
        return {nullptr, shape.get(), &object, object.getWorldTransform(), -1, -1};
    }

    std::vector<btScalar> points;
    std::vector<int> indices;
    std::unique_ptr<btTriangleIndexVertexArray> array;
    std::unique_ptr<btGImpactMeshShape> shape;
    btCollisionObject object;
};

/// Takes note of a contact and stores none.
struct AnyContact : btManifoldResult {
    using btManifoldResult::btManifoldResult;
    void addContactPoint(const btVector3&, const btVector3&, btScalar depth) override {
        touched = touched || depth <= 0;
    }
    bool touched = false;
};

/// Both bodies, and what Bullet keeps between two questions about them.
struct GimpactPair {
    GimpactPair(const ComparedPair& problem, const Eigen::AlignedBox3d& box)
        : centre(box.center()), scale(10 / box.diagonal().norm()), a(problem.meshA, centre, scale),
          b(problem.meshB, centre, scale), dispatcher(&configuration) {
        btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher);
        const btCollisionObjectWrapper wrappedA = a.wrapped(), wrappedB = b.wrapped();
        algorithm = dispatcher.findAlgorithm(&wrappedA, &wrappedB, nullptr, BT_CONTACT_POINT_ALGORITHMS);
    }
    ~GimpactPair() {
        algorithm->~btCollisionAlgorithm();
        dispatcher.freeCollisionAlgorithm(algorithm);
    }

    bool touch(const Pose& pose) {
        const Eigen::Matrix3d turn = pose.linear();
        // x' = R x + t with x = centre + y / scale
        const Vec3 shift = (turn * centre + pose.translation() - centre) * scale;
        const Eigen::Matrix<btScalar, 3, 3> r = turn.cast<btScalar>();
        const Eigen::Matrix<btScalar, 3, 1> t = shift.cast<btScalar>();
        const btMatrix3x3 rotation(r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1),
                                   r(2, 2));
        b.object.setWorldTransform(btTransform(rotation, btVector3(t.x(), t.y(), t.z())));
        const btCollisionObjectWrapper wrappedA = a.wrapped(), wrappedB = b.wrapped();
        AnyContact result(&wrappedA, &wrappedB);
        algorithm->processCollision(&wrappedA, &wrappedB, dispatchInfo, &result);
        return result.touched;
    }

    const Vec3 centre;
    const double scale;
    GimpactBody a, b;
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher;
    btCollisionAlgorithm* algorithm = nullptr;
    btDispatcherInfo dispatchInfo;
};

} // namespace

std::unique_ptr<CollisionMethod> makeGimpact(const ComparedPair& problem) {
    const Stopwatch watch;
    const Eigen::AlignedBox3d box = bounds(problem.meshA);
    const auto pair = std::make_shared<GimpactPair>(problem, box);
    const double seconds = watch.seconds();
    // Single precision, boxes quantised to 16 bits outwards: the triangles are judged in floats.
    const double band = 1e-5 * box.diagonal().norm();
    return makeMethod(
        {"bullet-gimpact",
         "mesh tree (Bullet)",
         "Bullet's GImpact on the triangles, single precision, every contact (it has no early out)",
         {band, band},
         pair->a.bytes() + pair->b.bytes(),
         seconds},
        [pair](const PoseQuery& query) { return pair->touch(query.pose); });
}

} // namespace tss::compare
