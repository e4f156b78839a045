// Writes the tank as a plain OSG file, from which osgTSS then takes what it needs:
//     tank tank.osgt && osgviewer -O "pairs=all tolerance=2cm" tank.osgt.tss
#include "Tank.h"

#include <osgDB/WriteFile>

#include <iostream>

int main(int argc, char** argv) {
    const std::string file = argc > 1 ? argv[1] : "tank.osgt";
    if (osgDB::writeNodeFile(*makeTank(), file)) return 0;
    std::cerr << "cannot write " << file << "\n";
    return 1;
}
