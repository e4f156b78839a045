#include "bake/base/Stopwatch.h"
#include "bake/compare/FclModel.h"
#include "bake/compare/Methods.h"

namespace tss::compare {

namespace {

template <class Volume>
class FclMethod final : public CollisionMethodLoop<FclMethod<Volume>> {
public:
    FclMethod(const ComparedPair& problem, const std::string& name, const std::string& remark) {
        const Stopwatch watch;
        fillFclModel(a_, problem.meshA);
        fillFclModel(b_, problem.meshB);
        const double seconds = watch.seconds();
        this->description() = {"fcl-" + name,
                               "mesh tree (FCL)",
                               "FCL's tree of " + name + " volumes on the triangles, first contact out" +
                                   remark,
                               {0, 0},
                               bytes(a_) + bytes(b_),
                               seconds};
        this->description().slow = name == "aabb";
    }

    bool hit(const PoseQuery& query) const override { return fclTouch(a_, b_, query.pose); }
    std::optional<double> gap(const PoseQuery& query) const override {
        return fclDistance(a_, b_, query.pose);
    }

private:
    static std::size_t bytes(const fcl::BVHModel<Volume>& model) {
        return static_cast<std::size_t>(model.getNumBVs()) * sizeof(fcl::BVNode<Volume>) +
               static_cast<std::size_t>(model.num_tris) * sizeof(fcl::Triangle) +
               static_cast<std::size_t>(model.num_vertices) * sizeof(fcl::Vector3d);
    }
    fcl::BVHModel<Volume> a_, b_;
};

} // namespace

std::unique_ptr<CollisionMethod> makeFcl(const ComparedPair& problem, const std::string& volume) {
    if (volume == "obb") return std::make_unique<FclMethod<fcl::OBBd>>(problem, volume, "");
    if (volume == "obbrss") return std::make_unique<FclMethod<fcl::OBBRSSd>>(problem, volume, "");
    return std::make_unique<FclMethod<fcl::AABBd>>(
        problem, "aabb", "; FCL copies, moves and refits the moving tree in each query");
}

} // namespace tss::compare
