#include "CollectTriangles.h"

#include <osg/TriangleFunctor>
#include <osg/TriangleIndexFunctor>
#include <osgTSS/Convert>

#include <algorithm>
#include <limits>
#include <map>

namespace osgTSS {

namespace {

/// Takes the points of triangles as they stand in the drawable.
class Collector {
public:
    Collector(const osg::Matrixd& matrix, double scale, bool mirrored, tss::TriangleMesh& mesh)
        : _matrix(matrix), _scale(scale), _mirrored(mirrored), _mesh(mesh) {}

    void add(const osg::Vec3d& a, const osg::Vec3d& b, const osg::Vec3d& c) {
        if (!finite(a) || !finite(b) || !finite(c)) {
            ++dropped;
            return;
        }
        const int i = vertex(a), j = vertex(b), k = vertex(c);
        if (i == j || j == k || k == i) return; // strips are stitched together with such
        _mesh.triangles.push_back(_mirrored ? tss::Tri(i, k, j) : tss::Tri(i, j, k));
    }

    std::size_t dropped = 0;

private:
    bool finite(const osg::Vec3d& point) const {
        return point.valid() && toCore(point * _matrix).allFinite();
    }

    int vertex(const osg::Vec3d& point) {
        const auto [entry, fresh] = _vertexAt.emplace(point, static_cast<int>(_mesh.vertices.size()));
        if (fresh) _mesh.vertices.push_back(_scale * toCore(point * _matrix));
        return entry->second;
    }

    const osg::Matrixd& _matrix;
    double _scale;
    bool _mirrored;
    tss::TriangleMesh& _mesh;
    std::map<osg::Vec3d, int> _vertexAt;
};

/// Takes triangles from a drawable that says their points itself.
struct Points {
    Collector* collector = nullptr;
    void operator()(const osg::Vec3& a, const osg::Vec3& b, const osg::Vec3& c) { collector->add(a, b, c); }
    // The signature of OSG before 3.5.
    void operator()(const osg::Vec3& a, const osg::Vec3& b, const osg::Vec3& c, bool) { (*this)(a, b, c); }
};

struct Corners {
    std::vector<std::array<unsigned int, 3>> all;
    void operator()(unsigned int a, unsigned int b, unsigned int c) { all.push_back({a, b, c}); }
};

/// A number of an array, whatever it is stored as.
double numberIn(const osg::Array& array, std::size_t index) {
    const void* data = array.getDataPointer();
    switch (array.getDataType()) {
    case GL_BYTE:
        return static_cast<const GLbyte*>(data)[index];
    case GL_UNSIGNED_BYTE:
        return static_cast<const GLubyte*>(data)[index];
    case GL_SHORT:
        return static_cast<const GLshort*>(data)[index];
    case GL_UNSIGNED_SHORT:
        return static_cast<const GLushort*>(data)[index];
    case GL_INT:
        return static_cast<const GLint*>(data)[index];
    case GL_UNSIGNED_INT:
        return static_cast<const GLuint*>(data)[index];
    case GL_FLOAT:
        return static_cast<const GLfloat*>(data)[index];
    case GL_DOUBLE:
        return static_cast<const GLdouble*>(data)[index];
    default:
        return std::numeric_limits<double>::quiet_NaN();
    }
}

bool shrunkToPoint(const osg::Matrixd& m) {
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            if (m(row, column) != 0) return false;
    return true;
}

} // namespace

double determinant(const osg::Matrixd& m) {
    const osg::Vec3d x(m(0, 0), m(0, 1), m(0, 2)), y(m(1, 0), m(1, 1), m(1, 2)), z(m(2, 0), m(2, 1), m(2, 2));
    return (x ^ y) * z;
}

std::vector<osg::Vec3d> pointsOf(const osg::Geometry& geometry) {
    const osg::Array* array = geometry.getVertexArray();
    const std::size_t size = array ? array->getDataSize() : 0;
    if (size < 2 || size > 4) return {};
    std::vector<osg::Vec3d> points(array->getNumElements());
    for (std::size_t p = 0; p < points.size(); ++p) {
        for (std::size_t k = 0; k < std::min<std::size_t>(size, 3); ++k)
            points[p][int(k)] = numberIn(*array, p * size + k);
        if (size == 4) points[p] = points[p] / numberIn(*array, p * size + 3);
    }
    return points;
}

std::vector<std::array<unsigned int, 3>> trianglesOf(const osg::Geometry& geometry) {
    osg::TriangleIndexFunctor<Corners> corners;
    for (const auto& primitives : geometry.getPrimitiveSetList())
        if (primitives) primitives->accept(corners);
    return std::move(corners.all);
}

bool drawsByShader(const osg::Drawable& drawable) {
    const osg::Geometry* geometry = drawable.asGeometry();
    return geometry && std::ranges::any_of(geometry->getPrimitiveSetList(), [](const auto& primitives) {
               if (!primitives || primitives->getNumIndices() == 0) return false;
               const GLenum mode = primitives->getMode();
               return mode == osg::PrimitiveSet::PATCHES || mode == osg::PrimitiveSet::TRIANGLES_ADJACENCY ||
                      mode == osg::PrimitiveSet::TRIANGLE_STRIP_ADJACENCY ||
                      primitives->getNumInstances() > 1;
           });
}

std::size_t collectTriangles(const osg::Drawable& drawable, const osg::Matrixd& matrix, double scale,
                             tss::TriangleMesh& mesh) {
    if (shrunkToPoint(matrix)) return 0; // draws nothing
    Collector collector(matrix, scale, (determinant(matrix) < 0) != (scale < 0), mesh);
    if (const osg::Geometry* geometry = drawable.asGeometry()) {
        const std::vector<osg::Vec3d> points = pointsOf(*geometry);
        for (const auto& [a, b, c] : trianglesOf(*geometry))
            if (std::max({a, b, c}) < points.size())
                collector.add(points[a], points[b], points[c]);
            else if (!points.empty())
                ++collector.dropped;
    } else {
        osg::TriangleFunctor<Points> functor;
        functor.collector = &collector;
        drawable.accept(functor);
    }
    return collector.dropped;
}

} // namespace osgTSS
