#include "bake/base/Stopwatch.h"
#include "bake/compare/FclModel.h"
#include "bake/compare/Methods.h"

namespace tss::compare {

namespace {

template <class Volume>
std::size_t bytesOf(const fcl::BVHModel<Volume>& model) {
    return static_cast<std::size_t>(model.getNumBVs()) * sizeof(fcl::BVNode<Volume>) +
           static_cast<std::size_t>(model.num_tris) * sizeof(fcl::Triangle) +
           static_cast<std::size_t>(model.num_vertices) * sizeof(fcl::Vector3d);
}

template <class Volume>
std::unique_ptr<CollisionMethod> makeTrees(const ComparedPair& problem, const std::string& name,
                                           const std::string& remark = "") {
    struct Trees {
        fcl::BVHModel<Volume> a, b;
    };
    const Stopwatch watch;
    const auto trees = std::make_shared<Trees>();
    fillFclModel(trees->a, problem.meshA);
    fillFclModel(trees->b, problem.meshB);
    const double seconds = watch.seconds();
    Description about{"fcl-" + name,
                      "mesh tree (FCL)",
                      "FCL's tree of " + name + " volumes on the triangles, first contact out" + remark,
                      {0, 0},
                      bytesOf(trees->a) + bytesOf(trees->b),
                      seconds};
    about.slow = name == "aabb";
    return makeMethod(std::move(about),
                      [trees](const PoseQuery& query) { return fclTouch(trees->a, trees->b, query.pose); });
}

} // namespace

std::unique_ptr<CollisionMethod> makeFcl(const ComparedPair& problem, const std::string& volume) {
    if (volume == "obb") return makeTrees<fcl::OBBd>(problem, volume);
    if (volume == "obbrss") return makeTrees<fcl::OBBRSSd>(problem, volume);
    return makeTrees<fcl::AABBd>(problem, "aabb",
                                 "; FCL copies, moves and refits the moving tree in each query");
}

} // namespace tss::compare
