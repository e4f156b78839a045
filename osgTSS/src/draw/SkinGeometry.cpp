#include <OpenThreads/ScopedLock>
#include <osg/NodeVisitor>
#include <osg/UserDataContainer>
#include <osgTSS/Convert>
#include <osgTSS/SkinGeometry>

#include <stdexcept>

namespace osgTSS {

namespace {

/// The bound of a geometry in the pair is that of the drawable that owns it.
class BoundOfOwner : public osg::Drawable::ComputeBoundingBoxCallback {
public:
    explicit BoundOfOwner(const SkinGeometry& owner) : _owner(owner) {}
    osg::BoundingBox computeBound(const osg::Drawable&) const override { return _owner.computeBoundingBox(); }

private:
    const SkinGeometry& _owner; ///< outlives the geometries it owns
};

/// A geometry like the one at rest over arrays of its own. normals: null for those at rest, whatever they
/// are.
osg::ref_ptr<osg::Geometry> over(const osg::Geometry& rest, osg::Vec3Array& vertices,
                                 osg::Vec3Array* normals) {
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry(rest, osg::CopyOp::SHALLOW_COPY);
    geometry->setUpdateCallback(nullptr);
    geometry->setVertexArray(&vertices);
    if (normals) geometry->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    return geometry;
}

osg::ref_ptr<osg::Vec3Array> copyOf(const osg::Vec3Array* array) {
    return array ? new osg::Vec3Array(*array, osg::CopyOp::DEEP_COPY_ALL) : nullptr;
}

const osg::Vec3Array* vec3Array(const osg::Array* array) {
    return dynamic_cast<const osg::Vec3Array*>(array);
}

/// Values of its own, and a copy of the drawable that it stands in place of, which is drawn again one day.
void copyReplaced(osg::Object& shown, const osg::CopyOp& copyop) {
    if (!shown.getUserDataContainer()) return;
    const osg::ref_ptr<osg::UserDataContainer> values =
        osg::clone(shown.getUserDataContainer(), osg::CopyOp::SHALLOW_COPY);
    for (unsigned int k = 0; k < values->getNumUserObjects(); ++k)
        if (auto* drawable = dynamic_cast<osg::Drawable*>(values->getUserObject(k)))
            values->setUserObject(k, copyop(drawable));
    shown.setUserDataContainer(values);
}

} // namespace

SkinGeometry::SkinGeometry() {
    setDataVariance(DYNAMIC);
    setUseDisplayList(false);
    setSupportsDisplayList(false);
}

SkinGeometry::SkinGeometry(const SkinGeometry& other, const osg::CopyOp& copyop)
    : osg::Drawable(other, copyop), _path(other._path) {
    setDataVariance(DYNAMIC);
    const auto flags = copyop.getCopyFlags();
    if ((flags & osg::CopyOp::DEEP_COPY_DRAWABLES) && !(flags & osg::CopyOp::DEEP_COPY_USERDATA))
        copyReplaced(*this, copyop);
    if (!other._rest) return;
    const bool deep = (copyop.getCopyFlags() & osg::CopyOp::DEEP_COPY_ARRAYS) != 0;
    setRestGeometry(deep ? osg::clone(other._rest.get(), copyop) : other._rest.get());
    *_vertices = *other._vertices;
    if (_normals) *_normals = *other._normals;
    changed(other._box);
}

void SkinGeometry::setRestGeometry(osg::Geometry* geometry) {
    const osg::ref_ptr<osg::Geometry> rest = geometry;
    const osg::Vec3Array* vertices = rest ? vec3Array(rest->getVertexArray()) : nullptr;
    if (!vertices) return;
    const osg::Vec3Array* normals = rest->getNormalBinding() == osg::Geometry::BIND_PER_VERTEX
                                        ? vec3Array(rest->getNormalArray())
                                        : nullptr;
    if (normals && normals->size() != vertices->size()) normals = nullptr;
    _rest = rest;
    _vertices = copyOf(vertices);
    _normals = copyOf(normals);
    _staged = over(*rest, *_vertices, _normals);
    for (osg::ref_ptr<osg::Geometry>& frame : _frames) {
        const osg::ref_ptr<osg::Vec3Array> v = copyOf(vertices), n = copyOf(normals);
        osg::ref_ptr<osg::VertexBufferObject> buffer = new osg::VertexBufferObject;
        buffer->setUsage(GL_DYNAMIC_DRAW_ARB);
        v->setVertexBufferObject(buffer);
        if (n) n->setVertexBufferObject(buffer);
        frame = over(*rest, *v, n);
        frame->setUseDisplayList(false);
        frame->setUseVertexBufferObjects(true);
        frame->setDataVariance(STATIC); // written only while nothing draws it: no viewer need wait for it
        frame->setComputeBoundingBoxCallback(new BoundOfOwner(*this));
    }
    _box.init();
    osg::BoundingBox box;
    for (const osg::Vec3& vertex : *vertices) box.expandBy(vertex);
    changed(box);
}

void SkinGeometry::deform(std::span<const std::uint32_t> vertices, std::span<const tss::Vec3> positions,
                          std::span<const tss::Vec3> normals) {
    if (vertices.size() != positions.size() || vertices.size() != normals.size())
        throw std::invalid_argument(
            "SkinGeometry::deform: expected as many positions and normals as vertices");
    const std::size_t count = _vertices ? _vertices->size() : 0;
    for (std::uint32_t vertex : vertices) // before any is moved
        if (vertex >= count)
            throw std::out_of_range("SkinGeometry::deform: vertex " + std::to_string(vertex) + " of " +
                                    std::to_string(count));
    osg::BoundingBox box;
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        osg::Vec3& vertex = (*_vertices)[vertices[k]];
        vertex = osg::Vec3(toOsg(positions[k]));
        if (_normals) (*_normals)[vertices[k]] = osg::Vec3(toOsg(normals[k]));
        box.expandBy(vertex);
    }
    changed(box);
}

void SkinGeometry::deform(std::span<const tss::Vec3> positions, std::span<const tss::Vec3> normals) {
    if (!_vertices || positions.size() != _vertices->size() || normals.size() != positions.size())
        throw std::invalid_argument("SkinGeometry::deform: expected a position and a normal a vertex");
    copyTo(*_vertices, positions);
    if (_normals) copyTo(*_normals, normals);
    osg::BoundingBox box;
    for (const osg::Vec3& vertex : *_vertices) box.expandBy(vertex);
    changed(box);
}

void SkinGeometry::changed(const osg::BoundingBox& box) {
    ++_version;
    if (!box.valid() || (_box.valid() && _box.contains(box._min) && _box.contains(box._max))) return;
    _box.expandBy(box);
    dirtyBound();
    for (const osg::ref_ptr<osg::Geometry>& frame : _frames) frame->dirtyBound();
}

osg::Geometry* SkinGeometry::geometryToDraw() {
    const OpenThreads::ScopedLock<OpenThreads::Mutex> lock(_mutex);
    if (!_frames[0]) return nullptr;
    if (_drawnVersion != _version) {
        _drawnVersion = _version;
        _current = 1 - _current;
        osg::Geometry& next = *_frames[_current];
        auto& vertices = static_cast<osg::Vec3Array&>(*next.getVertexArray());
        std::ranges::copy(*_vertices, vertices.begin());
        vertices.dirty();
        if (_normals) {
            auto& normals = static_cast<osg::Vec3Array&>(*next.getNormalArray());
            std::ranges::copy(*_normals, normals.begin());
            normals.dirty();
        }
        next.dirtyGLObjects(); // a vertex array object does not look at its buffers again by itself
    }
    osg::Geometry* geometry = _frames[_current];
    if (geometry->getStateSet() != getStateSet()) geometry->setStateSet(getStateSet());
    if (geometry->getCullCallback() != getCullCallback()) geometry->setCullCallback(getCullCallback());
    return geometry;
}

void SkinGeometry::accept(osg::NodeVisitor& visitor) {
    if (!visitor.validNodeMask(*this)) return;
    visitor.pushOntoNodePath(this);
    osg::Geometry* drawn =
        visitor.getVisitorType() == osg::NodeVisitor::CULL_VISITOR ? geometryToDraw() : nullptr;
    if (drawn)
        visitor.apply(*drawn);
    else
        visitor.apply(*this);
    visitor.popFromNodePath();
}

void SkinGeometry::accept(osg::PrimitiveFunctor& functor) const {
    if (_staged) _staged->accept(functor);
}

void SkinGeometry::accept(osg::PrimitiveIndexFunctor& functor) const {
    if (_staged) _staged->accept(functor);
}

void SkinGeometry::drawImplementation(osg::RenderInfo& info) const {
    if (_frames[_current]) _frames[_current]->drawImplementation(info);
}

void SkinGeometry::compileGLObjects(osg::RenderInfo& info) const {
    for (const osg::ref_ptr<osg::Geometry>& frame : _frames)
        if (frame) frame->compileGLObjects(info);
}

void SkinGeometry::resizeGLObjectBuffers(unsigned int size) {
    osg::Drawable::resizeGLObjectBuffers(size);
    for (const osg::ref_ptr<osg::Geometry>& frame : _frames)
        if (frame) frame->resizeGLObjectBuffers(size);
}

void SkinGeometry::releaseGLObjects(osg::State* state) const {
    osg::Drawable::releaseGLObjects(state);
    for (const osg::ref_ptr<osg::Geometry>& frame : _frames)
        if (frame) frame->releaseGLObjects(state);
}

void SkinGeometry::setThreadSafeRefUnref(bool threadSafe) {
    osg::Drawable::setThreadSafeRefUnref(threadSafe);
    for (const osg::ref_ptr<osg::Geometry>& frame : _frames)
        if (frame) frame->setThreadSafeRefUnref(threadSafe);
}

} // namespace osgTSS
