// A baked scene in a program without OpenSceneGraph: does this pose touch, where, and how far does the joint
// get on its way there? Arguments: the scene, then a value a degree of freedom (radians, or scene units).
#include "bake/respond/JointResponder.h"
#include "bake/scene/SceneFile.h"
#include "bake/table/Contact.h"
#include "bake/table/PreparedTable.h"

#include <cstdlib>
#include <iostream>

int main(int argc, char** argv) {
    if (argc < 2) {
        std::cerr << "usage: " << argv[0] << " SCENE VALUE... (radians, or scene units)\n";
        return 2;
    }
    const tss::SceneModel scene = tss::loadScene(argv[1]);
    const tss::Pair& pair = scene.pairs.at(0);
    if (!pair.table) return 1;                   // proven never to meet, or not baked
    const tss::PreparedTable table(*pair.table); // once; shared by any number of threads and instances
    if (argc - 2 != static_cast<int>(table.dofCount())) {
        std::cerr << "expected " << table.dofCount() << " values\n";
        return 2;
    }

    const std::vector<double> rest = tss::restValues(tss::pairMotion(scene, pair));
    std::vector<double> asked;
    for (int k = 2; k < argc; ++k) asked.push_back(std::atof(argv[k]));

    const tss::TableContact contact = table.contact(asked.data());
    std::cout << (table.hit(asked.data()) ? "touches" : "free") << ", gap " << contact.gap << " at "
              << contact.point.transpose() << "\n";

    const tss::JointResponder responder(*pair.table);
    tss::JointWorkspace workspace = responder.workspace(); // one a thread
    const tss::JointAnswer answer = responder.respond(rest.data(), asked.data(), workspace);
    std::cout << tss::name(answer.status) << " at";
    for (int k = 0; k < responder.dofCount(); ++k) std::cout << " " << answer.q[k];
    std::cout << "\n";
    return 0;
}
