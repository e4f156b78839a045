#pragma once
#include "bake/table/Table.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace adversary {

/// What an attack on one table or proof has found.
struct Findings {
    std::uint64_t poses = 0, contacts = 0; ///< judged; of these, those where the surfaces meet
    std::uint64_t fired = 0;               ///< the table reported contact
    std::uint64_t missed = 0, early = 0;   ///< beyond the bounds stated, and beyond rounding
    std::uint64_t kernel = 0; ///< the run-time kernel's verdict is not that of the exact gaps within its band
    std::uint64_t doubts = 0; ///< FCL and the distances of triangles disagree; nothing is made of those
    double latest = 0;        ///< largest gap - boundMiss at a contact, scene units
    double earliest = 0;      ///< largest distance of the surfaces at which contact was reported
    std::vector<double> worst; ///< the pose of the first failure
    std::string what;          ///< what it is
    bool failed() const { return missed || early || kernel; }
};

struct AttackOptions {
    std::uint64_t poses = 1000; ///< to judge, about
    std::uint64_t seed = 1;
    double seconds = 1e9;      ///< of processor time, after which a tenth of the poses is enough
    bool boundsAnyway = false; ///< take the bounds for claims though the table is not certified
};

/// Processor time of this process.
double processorSeconds();

/// Looks for poses at which a table breaks what it claims of two meshes (METHOD, what a table promises): rest
/// and its neighbourhood, corners of Q, rows of paths, random poses, the ends of bisected segments between
/// contact and its absence as the meshes and as the table see them, and climbing towards what would violate
/// the bounds. motion: of the scene, not of the table.
Findings attackTable(const tss::TriangleMesh& a, const tss::TriangleMesh& b, const tss::Motion& motion,
                     const tss::Table& table, const AttackOptions& options);

/// The same for a proof: nothing may come nearer than its clearance anywhere.
Findings attackProof(const tss::TriangleMesh& a, const tss::TriangleMesh& b, const tss::Motion& motion,
                     const tss::NeverCollides& proof, const AttackOptions& options);

} // namespace adversary
