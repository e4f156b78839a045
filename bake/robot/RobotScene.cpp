#include "bake/robot/RobotScene.h"

#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/base/Words.h"
#include "bake/model/AddPair.h"
#include "bake/robot/ReadMsh.h"
#include "bake/robot/Shapes.h"

#include <algorithm>
#include <optional>
#include <set>

namespace tss {

namespace {

constexpr std::size_t mostTriangles = 4'000'000;

bool isPoint(const RobotShape& shape) {
    return shape.kind != RobotShape::Kind::Mesh && shape.size.isZero(0);
}

class SceneMaker {
public:
    SceneMaker(const Robot& robot, const RobotSceneRequest& request, const FindMesh& findMesh)
        : robot_(robot), request_(request), findMesh_(findMesh) {
        result_.notes = robot.notes;
    }

    RobotScene make() {
        SceneModel& scene = result_.scene;
        scene.metersPerUnit = robot_.metersPerUnit;
        scene.upAxis = robot_.upAxis;
        scene.defaultPrim = freePrimName(scene, robot_.name.empty() ? "Robot" : robot_.name);
        if (scene.defaultPrim != robot_.name) scene.displayName = robot_.name;
        for (const RobotLink& link : robot_.links) addLink(link);
        const auto isEmpty = [](const Body& body) { return body.mesh.empty(); };
        if (!failures_.empty() && std::ranges::all_of(scene.bodies, isEmpty)) {
            const std::size_t more = failures_.size() - 1;
            throw InputError(failures_.front().where,
                             "no link has a shape that can be had: " + failures_.front().message +
                                 (more ? "; and " + std::to_string(more) + " more" : ""));
        }
        if (!others_.empty())
            result_.notes.push_back("these have no " + std::string(request_.visual ? "visual" : "collision") +
                                    " geometry that can be had, and their other one is taken: " + others_);
        if (!points_.empty())
            result_.notes.push_back("left out: points, shapes of no size: " + firstOf(points_, 20));
        if (!shapeless_.empty())
            result_.notes.push_back("these have no shape then, and whether they collide is not known: " +
                                    shapeless_);
        // A joint's parent has its place before the joint's child gets one.
        std::vector<bool> done(robot_.joints.size()), placed(robot_.links.size(), true);
        for (const RobotJoint& joint : robot_.joints) placed[joint.child] = false;
        chains_.resize(robot_.joints.size());
        for (bool again = true; again;) {
            again = false;
            for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
                const RobotJoint& joint = robot_.joints[j];
                if (done[j] || (joint.parent >= 0 && !placed[joint.parent])) continue;
                addJoint(j);
                again = done[j] = placed[joint.child] = true;
            }
        }
        if (!renamed_.empty())
            result_.notes.push_back("joints have other names in the scene: " + firstOf(renamed_, 5));
        for (const RobotSkin& skin : robot_.skins) addSkin(skin);
        addPairs();
        addMotion();
        return std::move(result_);
    }

private:
    TriangleMesh meshOfFile(const RobotShape& shape, const std::string& file) {
        if (file.empty()) throw InputError("file \"" + shape.file + "\": its package is left out");
        auto at = meshes_.find(shape.file);
        if (at == meshes_.end()) {
            MeshFileNotes said;
            TriangleMesh read = isMsh(file) ? readMsh(readWholeFile(file), file) : importMesh(file, &said);
            // A scale is the robot's own word on the unit.
            if (shape.size != Vec3::Ones()) said.metersPerUnit = 0;
            for (std::string& remark : remarks(shape.file, said, robot_.metersPerUnit))
                result_.notes.push_back(std::move(remark));
            at = meshes_.emplace(shape.file, std::move(read)).first;
        }
        TriangleMesh mesh = at->second;
        if (!(shape.size.cwiseAbs().minCoeff() > 0)) throw InputError("mesh: expected a scale that is not 0");
        for (Vec3& v : mesh.vertices) v = (shape.unscaled * v).cwiseProduct(shape.size);
        if (shape.size.prod() < 0)
            for (Tri& t : mesh.triangles) std::swap(t[1], t[2]);
        return mesh;
    }

    void append(const RobotShape& shape, const std::string& file, TriangleMesh& whole) {
        if (!shape.problem.empty()) throw InputError(shape.problem);
        if (isPoint(shape)) return;
        const TriangleMesh mesh = shape.mesh                             ? *shape.mesh
                                  : shape.kind == RobotShape::Kind::Mesh ? meshOfFile(shape, file)
                                                                         : meshOf(shape);
        triangles_ += mesh.triangles.size();
        if (triangles_ > mostTriangles)
            throw InputError("expected no more than " + std::to_string(mostTriangles) + " triangles in all");
        const auto offset = static_cast<int>(whole.vertices.size());
        for (const Vec3& v : mesh.vertices) whole.vertices.push_back(shape.place * v);
        for (const Tri& t : mesh.triangles) whole.triangles.emplace_back(t.array() + offset);
    }

    /// The mesh of all these shapes; none, and why, where one of them cannot be had: of a part of a link
    /// nothing can be proven.
    std::optional<TriangleMesh> meshOfShapes(const RobotLink& link, const std::vector<RobotShape>& shapes) {
        TriangleMesh whole;
        for (const RobotShape& shape : shapes) {
            bool isFound = false;
            try {
                const bool isNamed =
                    !shape.mesh && shape.problem.empty() && shape.kind == RobotShape::Kind::Mesh;
                const std::string file = isNamed ? findMesh_(shape.file) : "";
                isFound = true;
                append(shape, file, whole);
            } catch (const InputError& error) {
                const std::string of = error.where.file.empty() ? "" : error.where.file + ": ";
                const InputError placed(Where{robot_.file, shape.where, "link " + link.name},
                                        of + error.message);
                if (!isFound || triangles_ > mostTriangles) throw placed;
                failures_.push_back(placed);
                return std::nullopt;
            }
        }
        return whole;
    }

    Body bodyNamed(const std::string& name) const {
        Body body;
        const std::string free = freePrimName(result_.scene, name);
        body.path = "/" + result_.scene.defaultPrim + "/" + free;
        if (free != name) body.displayName = name;
        return body;
    }

    void addLink(const RobotLink& link) {
        SceneModel& scene = result_.scene;
        Body body = bodyNamed(link.name);
        body.named = link.named;
        LinkReport report{body.path, 0, request_.visual};
        const std::size_t failed = failures_.size();
        const auto take = [&](bool visual) {
            const auto& shapes = visual ? link.visual : link.collision;
            auto mesh = meshOfShapes(link, shapes);
            if (!mesh || mesh->empty()) return false;
            body.mesh = *std::move(mesh);
            report.shapes = shapes.size();
            report.visual = visual;
            return true;
        };
        if (!take(request_.visual) && take(!request_.visual))
            others_ += (others_.empty() ? "" : ", ") + link.name;
        if (std::ranges::any_of(request_.visual ? link.visual : link.collision, isPoint))
            points_.push_back(link.name);
        for (std::size_t k = failed; k < failures_.size(); ++k)
            result_.notes.push_back(std::string("left out: ") + failures_[k].what());
        if (failures_.size() > failed && body.mesh.empty())
            shapeless_ += (shapeless_.empty() ? "" : ", ") + link.name;
        const Vec3 tones[] = {{0.80, 0.79, 0.76}, {0.48, 0.56, 0.64}};
        body.displayColor = link.color.value_or(tones[scene.bodies.size() % 2]);
        body.rigid = true;
        body.visible = link.visible;
        body.placement = link.place;
        scene.bodies.push_back(std::move(body));
        result_.links.push_back(report);
    }

    /// The joint that this one follows and that moves, or the end.
    std::vector<RobotJoint>::const_iterator leaderOf(const RobotJoint& joint) const {
        if (joint.leader.empty()) return robot_.joints.end();
        return std::ranges::find_if(robot_.joints, [&](const RobotJoint& other) {
            return other.name == joint.leader && !other.dofs.empty();
        });
    }

    bool isLed(const RobotJoint& joint) const {
        return !joint.dofs.empty() && leaderOf(joint) != robot_.joints.end();
    }

    /// Where its leader at a value leads a joint.
    static double led(const RobotJoint& joint, double value) {
        return std::clamp(joint.factor * value + joint.offset, joint.dofs[0].lower, joint.dofs[0].upper);
    }

    double restOf(const RobotJoint& joint, const Dof& dof) const {
        const auto leader = leaderOf(joint);
        return leader == robot_.joints.end() ? std::clamp(dof.rest, dof.lower, dof.upper)
                                             : led(joint, restOf(*leader, leader->dofs[0]));
    }

    void addSkin(const RobotSkin& skin) {
        SceneModel& scene = result_.scene;
        Body body = bodyNamed(skin.name);
        body.mesh = skin.mesh;
        body.displayColor = skin.color.value_or(Vec3(0.80, 0.79, 0.76));
        body.visible = skin.visible;
        SkinModel model;
        model.path = body.path;
        model.body = static_cast<int>(scene.bodies.size());
        model.weights = {skin.links, skin.influences, skin.indices, skin.weights};
        scene.bodies.push_back(std::move(body));
        scene.skins.push_back(std::move(model));
        result_.links.push_back({scene.skins.back().path, 1, true});
    }

    /// One whose DOFs have a frame of their own.
    void addFramedJoint(std::size_t index) {
        const RobotJoint& joint = robot_.joints[index];
        Joint made;
        made.body0 = joint.parent, made.body1 = joint.child;
        made.frame0 = joint.origin * *joint.frame;
        made.frame1 = *joint.frame;
        made.dofs = joint.dofs;
        made.collisionEnabled = true;
        chains_[index] = {tss::addJoint(result_.scene, std::move(made), joint.name)};
    }

    void addJoint(std::size_t index) {
        const RobotJoint& joint = robot_.joints[index];
        if (joint.frame) return addFramedJoint(index);
        Motion motion;
        motion.base = joint.origin;
        for (Dof dof : joint.dofs) { // in the parent's frame
            dof.rest = restOf(joint, dof);
            dof.axis = joint.origin.linear() * dof.axis;
            dof.origin = dof.kind == DofKind::Rotation ? Vec3(joint.origin * dof.origin) : Vec3(Vec3::Zero());
            if (dof.kind == DofKind::Rotation) dof.axis.normalize();
            motion.dofs.push_back(dof);
        }
        const std::string name = freePrimName(result_.scene, joint.name.empty() ? "joint" : joint.name);
        if (name != joint.name && !joint.name.empty()) renamed_.push_back(joint.name + " is " + name);
        chains_[index] = addJoints(result_.scene, joint.parent, joint.child, motion, name);
        for (int j : chains_[index]) result_.scene.joints[j].collisionEnabled = true;
    }

    bool isWanted(int bodyA, int bodyB) const {
        if (unpaired_.contains(std::minmax(bodyA, bodyB))) return false;
        if (request_.pairs != RobotPairs::Neighbours) return !seams_.contains(std::minmax(bodyA, bodyB));
        return std::ranges::any_of(robot_.joints, [&](const RobotJoint& joint) {
            return std::minmax(joint.parent, joint.child) == std::minmax(bodyA, bodyB);
        });
    }

    void findUnpaired() {
        std::map<std::string, int> links;
        for (const RobotLink& link : robot_.links) links.emplace(link.name, static_cast<int>(links.size()));
        for (const auto& [from, to] : {std::pair(&robot_.unpaired, &unpaired_), {&robot_.seams, &seams_}})
            for (const auto& [a, b] : *from)
                if (links.contains(a) && links.contains(b)) to->insert(std::minmax(links.at(a), links.at(b)));
    }

    void addPairs() {
        findUnpaired();
        const AllPairs found = addAllPairs(result_.scene);
        std::vector<Pair>& pairs = result_.scene.pairs;
        std::erase_if(pairs, [&](const Pair& pair) {
            const auto links = std::minmax(pair.bodyA, pair.bodyB);
            return request_.pairs != RobotPairs::Neighbours && seams_.contains(links) &&
                   !unpaired_.contains(links);
        });
        const std::size_t all = pairs.size();
        std::erase_if(pairs, [&](const Pair& pair) { return !isWanted(pair.bodyA, pair.bodyB); });
        std::ranges::copy_if(found.unmade, std::back_inserter(result_.unmade),
                             [&](const AllPairs::Unmade& none) { return isWanted(none.bodyA, none.bodyB); });
        if (request_.pairs != RobotPairs::Neighbours && pairs.size() < all)
            result_.notes.push_back("pairs whose collision the robot's files switch off, left out: " +
                                    std::to_string(all - pairs.size()));
    }

    /// The file's own motion, or one that shows each joint.
    void addMotion() {
        const auto driven = [](const RobotJoint& joint) { return !joint.drives.empty(); };
        SceneModel& scene = result_.scene;
        if (std::ranges::none_of(robot_.joints, driven)) {
            std::set<std::size_t> led;
            for (std::size_t j = 0; j < robot_.joints.size(); ++j)
                if (isLed(robot_.joints[j])) led.insert(chains_[j].front());
            addShowMotion(scene, led);
            return coupleMotion();
        }
        scene.timeCodesPerSecond = robot_.timeCodesPerSecond;
        scene.startTimeCode = robot_.startTimeCode;
        scene.endTimeCode = robot_.endTimeCode;
        for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
            if (!driven(robot_.joints[j])) continue;
            auto drive = robot_.joints[j].drives.begin();
            for (int part : chains_[j])
                for (TimeSamples& samples : scene.joints[part].drives) samples = *drive++;
        }
    }

    /// Those that follow go where their leaders do, at each key of theirs.
    void coupleMotion() {
        std::vector<Joint>& joints = result_.scene.joints;
        for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
            const RobotJoint& joint = robot_.joints[j];
            if (!isLed(joint)) continue;
            const auto leader = leaderOf(joint);
            Joint& follower = joints[chains_[j].front()];
            TimeSamples drive = joints[chains_[leader - robot_.joints.begin()].front()].drives[0];
            for (double& value : drive.values) value = led(joint, value);
            follower.drives = {drive};
        }
    }

    const Robot& robot_;
    const RobotSceneRequest& request_;
    const FindMesh& findMesh_;
    std::string others_;               ///< links that are made of the other kind of shapes
    std::vector<InputError> failures_; ///< shapes that could not be had
    std::string shapeless_;            ///< links that have none for that
    std::vector<std::string> points_;  ///< links with a shape that is a point
    std::vector<std::string> renamed_; ///< joints, "old is new"
    RobotScene result_;
    std::map<std::string, TriangleMesh> meshes_;
    std::size_t triangles_ = 0;
    std::vector<std::vector<int>> chains_;   ///< the joints of the scene, per joint of the robot
    std::set<std::pair<int, int>> unpaired_; ///< bodies whose collision is switched off, the lower first
    std::set<std::pair<int, int>> seams_;    ///< the same: that meet at every pose
};

} // namespace

RobotScene sceneOf(const Robot& robot, const RobotSceneRequest& request, const FindMesh& findMesh) {
    return SceneMaker(robot, request, findMesh).make();
}

} // namespace tss
