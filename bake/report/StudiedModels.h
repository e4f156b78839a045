#pragma once
#include "bake/report/Model.h"
#include "bake/report/Study.h"

namespace tss::reporting {

/// A model of the pair under study, with the methods that were made for it.
struct StudiedModel {
    std::unique_ptr<Model> model;
    std::string about; ///< in words, where its name does not say it
    MethodScope scope;
    MethodSet methods{};
};

/// All models of one pair: what the report's rows stand on. Their figures go into the study as each is made.
class StudiedModels {
public:
    StudiedModels(PairStudy& study, const SceneModel& scene, const Pair& pair, bool quick,
                  const Progress& progress)
        : study_(study), scene_(scene), pair_(pair), quick_(quick), progress_(progress) {}

    /// Tables of ever finer spheres, the base among them: what `tss bake` makes of these meshes, but for
    /// contact at rest, which counts here as it does to the meshes. Returns the base.
    const Model& addTolerances(const TriangleMesh& a, const TriangleMesh& b);
    /// Tables over the base's spheres for other epsilons.
    void addEpsilons();
    /// Other spheres and tables at the base's tolerance: what the paper does, and what is lost or won.
    void addOtherRecipes();
    /// Leaves out the models whose tables have no test, and returns all others.
    std::vector<StudiedModel> takeTested();

private:
    const Model& base() const { return *all_[base_].model; }
    BakeOptions startOptions(const TriangleMesh& a, const TriangleMesh& b);
    void tell(const std::string& what) const;
    void add(std::vector<BakePoint>& points, std::unique_ptr<Model> model, MethodScope scope,
             const std::string& about = "");
    void addSpheres(const Recipe& recipe, const std::string& about);
    void addTable(const Recipe& recipe, const std::string& about);

    PairStudy& study_;
    const SceneModel& scene_;
    const Pair& pair_;
    const bool quick_;
    const Progress& progress_;
    std::vector<StudiedModel> all_;
    std::size_t base_ = 0; ///< place among all
};

} // namespace tss::reporting
