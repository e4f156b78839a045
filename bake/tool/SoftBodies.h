#pragma once
#include "bake/robot/RobotScene.h"
#include "bake/tool/Command.h"

namespace tss::tool {

/// What "[NAME=]MESH" says on the command line; without NAME the file gives it.
struct NamedMesh {
    std::string name, file;
};
NamedMesh namedMesh(const std::string& text);

/// Adds the muscles and skins of `tss make` to a scene whose rigid bodies are the links of a robot, and notes
/// what is odd about them. Keeps references to all three.
class SoftBodies {
public:
    SoftBodies(RobotScene& made, const Robot& robot, const Console& console)
        : made_(made), scene_(made.scene), robot_(robot), console_(console) {}

    /// text: [NAME=]MESH[,from=BODY,to=BODY,contract=0.15,sheet|ring]. Throws InputError that quotes it.
    void addMuscle(const std::string& text);

    /// A skin over all muscles so far and over these bodies, all where none is named. text: [NAME=]MESH.
    /// Throws InputError.
    void addSkin(const std::string& text, const std::vector<std::string>& bones);

private:
    std::string pathOf(const std::string& name) const;
    void note(const std::string& text) { made_.notes.push_back(text); }
    /// Returns the body's index.
    int addBody(const NamedMesh& mesh, const std::string& name, const Pose& placement, const Vec3& color);
    void setFibre(const std::string& name, MuscleModel& model, const Pose& placement);
    std::vector<double> towardsInsertion(const MuscleModel& model, const Pose& placement) const;
    void say(const std::string& name, const MuscleModel& model) const;
    void remarkVolume(const std::string& name, const TriangleMesh& mesh);
    void remarkOtherBones(const std::string& name, const MuscleModel& model);
    void remark(const std::string& name, const SkinModel& skin);

    RobotScene& made_;
    SceneModel& scene_;
    const Robot& robot_;
    const Console& console_;
};

} // namespace tss::tool
