#pragma once
#include "bake/verify/MeshProof.h"

#include <string>
#include <vector>

namespace tss::verify {

/// How far each sphere sticks out of a body: of what its surface encloses, and of the surface alone.
struct StickingOut {
    std::vector<double> body, surface;
};
StickingOut stickingOut(const VerifiedBody& body, const std::vector<Sphere>& spheres);

/// The most that the spheres of a test stick out together, with what its threshold adds. a, b: of each
/// sphere.
double mostTogether(const std::vector<MeshTest>& tests, const std::vector<double>& a,
                    const std::vector<double>& b);

/// What the record of a table says that its spheres, tests and bounds contradict, in words; empty: nothing.
/// No stored sphere may stick out of its body by more than tss:protrusion; no test may count as contact from
/// a gap of more than tss:epsilon on, so that contact is reported of bodies no farther apart than these three
/// together; tss:coverage may not be less than what the table is proven to miss by; and what is counted may
/// not be less than what is there (more, for the lower bound). `band`: rounding granted, scene units.
std::string contradiction(const Table& table, const StickingOut& a, const StickingOut& b, double band);

} // namespace tss::verify
