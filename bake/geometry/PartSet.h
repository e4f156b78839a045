#pragma once
#include "bake/geometry/SurfacePart.h"

#include <unordered_set>
#include <vector>

namespace tss {

/// A set of parts of one mesh's surface. Parts may be put in twice and inside one another.
class PartSet {
public:
    bool empty() const { return in_.empty(); }

    void insert(SurfacePart part);

    /// All of the part lies in the set, as one part of it.
    bool contains(SurfacePart part) const;

    /// The same, asked of a part whose wholes are known not to be.
    bool holds(SurfacePart part) const;

    /// Some part in the set is this one or a part of it.
    bool reaches(SurfacePart part) const;

    /// The same surface in as few parts as there are: two halves become the whole; sorted.
    std::vector<SurfacePart> merged() const;

private:
    std::unordered_set<std::uint64_t> in_; ///< the parts; perhaps others inside them, but no two halves
    std::unordered_set<std::uint64_t>
        above_; ///< all parts that were put in, and all of which these are parts
};

/// The two halves of a part, in the order of halves(). Its cuts must be fewer than mostCuts.
std::array<SurfacePart, 2> halves(SurfacePart part);

/// The same parts of another mesh that has the triangles of this one among its own, at the same places: of
/// all that are there, should one be there more than once. Sorted.
std::vector<SurfacePart> partsOf(const TriangleMesh& other, const TriangleMesh& mesh,
                                 const std::vector<SurfacePart>& parts);

/// The parts as a mesh of their own, three vertices a part.
TriangleMesh meshOf(const TriangleMesh& mesh, const std::vector<SurfacePart>& parts);

/// Area of the parts; of the whole mesh.
double area(const TriangleMesh& mesh, const std::vector<SurfacePart>& parts);
double area(const TriangleMesh& mesh);

} // namespace tss
