#include "bake/robot/ReadRobot.h"

#include "bake/motion/WholeTurn.h"
#include "bake/robot/UrdfText.h"
#include "bake/robot/Xml.h"

#include <console_bridge/console.h>
#include <map>
#include <urdf_parser/urdf_parser.h>

namespace tss {

using tinyxml2::XMLElement;

namespace {

/// Keeps what urdfdom says, instead of printing it.
class UrdfdomMessages : public console_bridge::OutputHandler {
public:
    UrdfdomMessages() { console_bridge::useOutputHandler(this); }
    ~UrdfdomMessages() override { console_bridge::restorePreviousOutputHandler(); }
    UrdfdomMessages(const UrdfdomMessages&) = delete;
    UrdfdomMessages& operator=(const UrdfdomMessages&) = delete;
    void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
        if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) all += (all.empty() ? "" : "; ") + text;
    }
    std::string all;
};

urdf::ModelInterfaceSharedPtr parse(const XMLElement& top, const std::string& file) {
    UrdfdomMessages messages;
    std::string thrown;
    try {
        if (auto model = urdf::parseURDF(urdfText(top))) return model;
    } catch (const std::exception& error) {
        thrown = error.what();
    }
    throw InputError(Where{file}, "is no URDF that can be read: " + messages.all + thrown);
}

Vec3 vector(const urdf::Vector3& v) {
    return {v.x, v.y, v.z};
}

Pose poseOf(const urdf::Pose& p) {
    Pose pose = Pose::Identity();
    pose.linear() = Eigen::Quaterniond(p.rotation.w, p.rotation.x, p.rotation.y, p.rotation.z)
                        .normalized()
                        .toRotationMatrix();
    // Exact where it turns nothing.
    if (p.rotation.x == 0 && p.rotation.y == 0 && p.rotation.z == 0) pose.linear().setIdentity();
    pose.translation() = vector(p.position);
    return pose;
}

class UrdfReader {
public:
    UrdfReader(const XMLElement& top, const std::string& file, Robot& robot) : file_(file), robot_(robot) {
        for (auto* e = top.FirstChildElement("link"); e; e = e->NextSiblingElement("link")) nameLink(*e);
        for (auto* e = top.FirstChildElement("joint"); e; e = e->NextSiblingElement("joint")) nameJoint(*e);
        checkForest(robot); // what urdfdom makes of a loop is never freed
        model_ = parse(top, file);
        robot.name = model_->getName();
        for (auto* e = top.FirstChildElement("link"); e; e = e->NextSiblingElement("link")) readLink(*e);
        std::vector<RobotJoint> named;
        named.swap(robot.joints);
        for (RobotJoint& joint : named) readJoint(std::move(joint));
    }

private:
    RobotShape readShape(const urdf::Geometry& geometry, const urdf::Pose& origin,
                         const XMLElement& element) const {
        RobotShape shape;
        shape.place = poseOf(origin);
        shape.where = placeOf(file_, element).pointer;
        if (const auto* box = dynamic_cast<const urdf::Box*>(&geometry)) {
            shape.kind = RobotShape::Kind::Box;
            shape.size = vector(box->dim);
        } else if (const auto* cylinder = dynamic_cast<const urdf::Cylinder*>(&geometry)) {
            shape.kind = RobotShape::Kind::Cylinder;
            shape.size = {cylinder->radius, cylinder->length, 0};
        } else if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(&geometry)) {
            shape.kind = RobotShape::Kind::Sphere;
            shape.size = {sphere->radius, 0, 0};
        } else if (const auto* mesh = dynamic_cast<const urdf::Mesh*>(&geometry)) {
            shape.size = vector(mesh->scale);
            shape.file = mesh->filename;
        }
        return shape;
    }

    /// The urdfdom array holds those elements that are left in the tree, in their order.
    template <class Items>
    std::vector<RobotShape> readShapes(const XMLElement& link, const char* kind, const Items& items) const {
        std::vector<RobotShape> shapes;
        auto* element = link.FirstChildElement(kind);
        for (const auto& item : items) {
            while (element && !element->FirstChildElement("geometry"))
                element = element->NextSiblingElement(kind);
            if (!element || !item || !item->geometry) continue;
            const XMLElement* shape = element->FirstChildElement("geometry")->FirstChildElement();
            shapes.push_back(readShape(*item->geometry, item->origin, shape ? *shape : *element));
            element = element->NextSiblingElement(kind);
        }
        return shapes;
    }

    void nameLink(const XMLElement& element) {
        RobotLink link;
        link.name = textOf(element, "name");
        index_[link.name] = static_cast<int>(robot_.links.size());
        robot_.links.push_back(std::move(link));
    }

    void nameJoint(const XMLElement& element) {
        RobotJoint joint;
        joint.name = textOf(element, "name");
        joint.where = placeOf(file_, element).pointer;
        joint.parent = index_.at(textOf(*element.FirstChildElement("parent"), "link"));
        joint.child = index_.at(textOf(*element.FirstChildElement("child"), "link"));
        robot_.joints.push_back(std::move(joint));
    }

    void readLink(const XMLElement& element) {
        const auto model = model_->getLink(textOf(element, "name"));
        RobotLink& link = robot_.links[index_.at(model->name)];
        link.collision = readShapes(element, "collision", model->collision_array);
        link.visual = readShapes(element, "visual", model->visual_array);
        link.color = urdfColor(file_, element);
        for (auto at = model; at->parent_joint; at = at->getParent()) // where its joints are at 0
            link.place = poseOf(at->parent_joint->parent_to_joint_origin_transform) * link.place;
    }

    void readJoint(RobotJoint joint) {
        const auto model = model_->getJoint(joint.name);
        joint.origin = poseOf(model->parent_to_joint_origin_transform);
        const auto leaveOut = [&](const std::string& why) {
            robot_.notes.push_back(
                leftOutJoint(joint.name, joint.where, why, robot_.links[joint.child].name));
        };
        if (model->type == urdf::Joint::PLANAR) return leaveOut("is planar, without limits");
        if (model->type == urdf::Joint::FLOATING) return leaveOut("is floating, without limits");
        if (model->type != urdf::Joint::FIXED) {
            const auto& limits = model->limits;
            if (model->type != urdf::Joint::CONTINUOUS && limits->lower > limits->upper)
                return leaveOut("has a lower limit above its upper one");
            readDof(*model, joint);
        }
        robot_.joints.push_back(std::move(joint));
    }

    static void readDof(const urdf::Joint& model, RobotJoint& joint) {
        Dof dof;
        dof.kind = model.type == urdf::Joint::PRISMATIC ? DofKind::Translation : DofKind::Rotation;
        const Vec3 axis = vector(model.axis);
        dof.axis = axis.norm() == 1 ? axis : Vec3(axis.stableNormalized());
        if (model.type == urdf::Joint::CONTINUOUS) {
            setWholeTurn(dof);
            joint.endless = true;
        } else {
            dof.lower = model.limits->lower;
            dof.upper = model.limits->upper;
        }
        if (model.mimic) {
            joint.leader = model.mimic->joint_name;
            joint.factor = model.mimic->multiplier;
            joint.offset = model.mimic->offset;
        }
        joint.dofs.push_back(dof);
    }

    std::string file_;
    Robot& robot_;
    urdf::ModelInterfaceSharedPtr model_;
    std::map<std::string, int> index_;
};

} // namespace

Robot readUrdf(const std::string& text, const std::string& file) {
    const auto document = parseXml(text, file, "robot");
    Robot robot;
    XMLElement& top = *document->RootElement();
    const PrunedUrdf pruned = pruneUrdf(top, file);
    robot.file = file;
    robot.notes = pruned.notes;
    UrdfReader(top, file, robot);
    for (const auto& [name, visual, shape] : pruned.shapes)
        for (RobotLink& link : robot.links)
            if (link.name == name) (visual ? link.visual : link.collision).push_back(shape);
    settleRobot(robot);
    return robot;
}

void readSrdf(Robot& robot, const std::string& text, const std::string& file) {
    const auto document = parseXml(text, file, "robot");
    const auto has = [&](const std::string& name) {
        return std::ranges::any_of(robot.links, [&](const RobotLink& link) { return link.name == name; });
    };
    const XMLElement& top = *document->RootElement();
    if (top.FirstChildElement("link"))
        throw InputError(placeOf(file, *top.FirstChildElement("link")),
                         "expected an SRDF, found a URDF's <link>");
    if (const std::string name = textOf(top, "name"); name != robot.name)
        robot.notes.push_back(file + " is that of a robot \"" + name + "\", not of \"" + robot.name + "\"");
    for (auto* e = top.FirstChildElement("disable_collisions"); e;
         e = e->NextSiblingElement("disable_collisions")) {
        const std::string a = textOf(*e, "link1"), b = textOf(*e, "link2");
        if (a.empty() || b.empty())
            throw InputError(placeOf(file, *e), "expected the attributes link1 and link2");
        if (!has(a) || !has(b))
            robot.notes.push_back(file + ": " + placeOf(file, *e).pointer + ": the robot has no link \"" +
                                  (has(a) ? b : a) + "\"");
        else
            robot.unpaired.emplace_back(a, b);
    }
}

} // namespace tss
