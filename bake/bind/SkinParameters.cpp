#include "bake/bind/SkinParameters.h"

#include "bake/base/Error.h"

#include <cmath>

namespace tss {
namespace {

void checkNumber(double value, const char* what) {
    if (!(value >= 0) || !std::isfinite(value))
        throw InputError(std::string(what) + " of a skin must be finite and at least 0");
}

} // namespace

void checkSkin(const TriangleMesh& skin, std::size_t bodies, const SkinParameters& p) {
    checkNumber(p.stretchCompliance, "the stretch compliance");
    checkNumber(p.bendCompliance, "the bend compliance");
    for (const auto* weights : {&p.tether, &p.attach}) {
        if (!weights->empty() && weights->size() != skin.vertices.size())
            throw InputError("tether and attach of a skin need one value a vertex");
        for (const double w : *weights)
            if (!(w >= 0 && w <= 1)) throw InputError("tether and attach of a skin lie in [0, 1]");
    }
    if (!p.frames.empty() && p.frames.size() != bodies)
        throw InputError("a skin needs one frame a muscle or bone below it");
    for (const int frame : p.frames)
        if (frame < -1 || frame >= static_cast<int>(bodies))
            throw InputError("a frame of a skin is numbered from 0 and fewer than its bodies");
    if (!p.chains.empty() && p.chains.size() != bodies)
        throw InputError("a skin needs one chain of bones a muscle or bone below it");
    for (const std::vector<int>& chain : p.chains)
        for (const int body : chain)
            if (body < 0 || body >= static_cast<int>(bodies))
                throw InputError("the bones of a muscle under a skin are of the bodies below it");
    for (const std::vector<double>& list : p.shares) {
        if (list.size() != skin.vertices.size())
            throw InputError("the shares of a skin need one value a vertex");
        for (const double w : list)
            if (!(w >= 0 && w <= 1)) throw InputError("the shares of a skin lie in [0, 1]");
    }
    for (const std::vector<BoneSwing>* swings : {&p.swings, &p.together})
        for (const BoneSwing& swing : *swings)
            for (const std::vector<Pose>& station : swing)
                if (station.size() != bodies)
                    throw InputError("the swings of the bones under a skin need one pose a muscle or bone");
    if (p.iterations < 1) throw InputError("a skin needs at least one iteration");
}

} // namespace tss
