/* Worlds of Bullet with soft bodies; lengths in metres, z is up. */
#include "tests/engine/bullet_scenes.hpp"

#include <BulletSoftBody/btSoftBodyHelpers.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace {

constexpr double pi = 3.14159265358979323846, gravity = 9.81, body_margin = 0.008;

btVector3 point_of(double x, double y, double z) {
    return {static_cast<btScalar>(x), static_cast<btScalar>(y), static_cast<btScalar>(z)};
}

btTransform moved_by(double x, double y, double z) {
    return btTransform(btQuaternion::getIdentity(), point_of(x, y, z));
}

btTransform turned_by(double angle) {
    return btTransform(btQuaternion(btVector3(0, 0, 1), static_cast<btScalar>(angle)));
}

/* Rises smoothly from 0 to 1. */
double smooth_share(double time, double begin, double seconds) {
    const double part = std::clamp((time - begin) / seconds, 0.0, 1.0);
    return part * part * (3.0 - 2.0 * part);
}

} // namespace

/* ---- surfaces ------------------------------------------------------------------------------------------ */

bullet_scene::surface bullet_scene::sheet_of(unsigned triangle_count, double width) {
    surface s;
    const unsigned side = static_cast<unsigned>(std::lround(std::sqrt(0.5 * triangle_count)));
    for (unsigned i = 0; i <= side; i++)
        for (unsigned j = 0; j <= side; j++)
            s.points.push_back(
                point_of(width * (double(i) / side - 0.5), width * (double(j) / side - 0.5), 0.0));
    for (unsigned i = 0; i < side; i++) {
        for (unsigned j = 0; j < side; j++) {
            const unsigned a = i * (side + 1) + j, b = a + side + 1;
            const bool rising = (i + j) % 2 == 0;
            s.triangles.push_back({a, b, rising ? b + 1 : a + 1});
            s.triangles.push_back({rising ? a : b, b + 1, a + 1});
        }
    }
    return s;
}

/* An icosahedron whose faces are cut into equal triangles. */
bullet_scene::surface bullet_scene::ball_of(unsigned triangle_count, double radius) {
    surface s;
    const double g = 0.5 * (1.0 + std::sqrt(5.0));
    const btVector3 corners[12] = {point_of(-1, g, 0),  point_of(1, g, 0),   point_of(-1, -g, 0),
                                   point_of(1, -g, 0),  point_of(0, -1, g),  point_of(0, 1, g),
                                   point_of(0, -1, -g), point_of(0, 1, -g),  point_of(g, 0, -1),
                                   point_of(g, 0, 1),   point_of(-g, 0, -1), point_of(-g, 0, 1)};
    static const unsigned char faces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                               {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                               {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                               {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    const unsigned n = std::max(1u, static_cast<unsigned>(std::lround(std::sqrt(triangle_count / 20.0))));
    std::map<std::array<int, 3>, unsigned> known;
    const auto vertex_at = [&](const unsigned char *face, unsigned i, unsigned j) {
        btVector3 p = (corners[face[0]] * btScalar(n - i - j) + corners[face[1]] * btScalar(i) +
                       corners[face[2]] * btScalar(j))
                          .normalized() *
                      static_cast<btScalar>(radius);
        std::array<int, 3> key;
        for (int k = 0; k < 3; k++)
            key[static_cast<std::size_t>(k)] = static_cast<int>(std::lround(p[k] / radius * 1e4));
        const auto [place, is_new] = known.emplace(key, static_cast<unsigned>(s.points.size()));
        if (is_new) s.points.push_back(p);
        return place->second;
    };
    for (const auto &face : faces) {
        for (unsigned i = 0; i < n; i++) {
            for (unsigned j = 0; i + j < n; j++) {
                s.triangles.push_back(
                    {vertex_at(face, i, j), vertex_at(face, i + 1, j), vertex_at(face, i, j + 1)});
                if (i + j + 1 < n)
                    s.triangles.push_back({vertex_at(face, i + 1, j), vertex_at(face, i + 1, j + 1),
                                           vertex_at(face, i, j + 1)});
            }
        }
    }
    return s;
}

/* Open at both ends. */
bullet_scene::surface bullet_scene::tube_of(unsigned triangle_count, double radius, double height) {
    surface s;
    const unsigned around =
        static_cast<unsigned>(std::lround(std::sqrt(0.5 * triangle_count * 2.0 * pi * radius / height)));
    const unsigned rows = triangle_count / (2 * around);
    for (unsigned i = 0; i <= rows; i++) {
        for (unsigned j = 0; j < around; j++) {
            const double angle = 2.0 * pi * (j + 0.5 * (i % 2)) / around;
            s.points.push_back(
                point_of(radius * std::cos(angle), radius * std::sin(angle), height * i / rows));
        }
    }
    for (unsigned i = 0; i < rows; i++) {
        for (unsigned j = 0; j < around; j++) {
            const unsigned next = (j + 1) % around, a = i * around + j, b = i * around + next, c = a + around,
                           d = b + around;
            const bool odd = i % 2 == 1;
            s.triangles.push_back({a, b, odd ? d : c});
            s.triangles.push_back({odd ? a : b, d, c});
        }
    }
    return s;
}

/* The top of a plate is at height 0. */
bullet_scene::surface bullet_scene::plate_of(double reach, double thickness) {
    surface s;
    for (unsigned i = 0; i < 8; i++)
        s.points.push_back(
            point_of(i & 1 ? reach : -reach, i & 2 ? reach : -reach, i & 4 ? 0.0 : -thickness));
    static const unsigned char sides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                              {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto &side : sides) {
        s.triangles.push_back({side[0], side[1], side[2]});
        s.triangles.push_back({side[0], side[2], side[3]});
    }
    return s;
}

/* ---- bodies -------------------------------------------------------------------------------------------- */

btSoftBody &bullet_scene::add_soft(const surface &s, const btTransform &place, double mass,
                                   double bending_stiffness) {
    std::vector<btScalar> coordinates;
    std::vector<int> indices;
    for (const btVector3 &p : s.points)
        for (int k = 0; k < 3; k++) coordinates.push_back((place * p)[k]);
    for (const auto &t : s.triangles) indices.insert(indices.end(), t.begin(), t.end());
    soft_.emplace_back(btSoftBodyHelpers::CreateFromTriMesh(
        world_->getWorldInfo(), coordinates.data(), indices.data(), static_cast<int>(s.triangles.size())));
    btSoftBody &body = *soft_.back();
    double sum = 0.0;
    for (int i = 0; i < body.m_links.size(); i++) sum += body.m_links[i].m_rl;
    spacing_ = sum / body.m_links.size();
    btSoftBody::Material *bending = body.appendMaterial();
    bending->m_kLST = static_cast<btScalar>(bending_stiffness);
    body.generateBendingConstraints(2, bending);
    body.setTotalMass(static_cast<btScalar>(mass));
    body.m_cfg.piterations = 10;
    body.m_cfg.kDF = btScalar(0.4);
    body.m_cfg.kDP = btScalar(0.005);
    body.m_cfg.kKHR = btScalar(1);
    body.m_cfg.collisions = collides_ ? btSoftBody::fCollision::SDF_RS | btSoftBody::fCollision::VF_SS : 0;
    body.getCollisionShape()->setMargin(static_cast<btScalar>(body_margin));
    body.setActivationState(DISABLE_DEACTIVATION);
    world_->addSoftBody(&body);
    return body;
}

void bullet_scene::add_obstacle(const surface &s, std::unique_ptr<btCollisionShape> outline,
                                const std::function<btTransform(double)> &pose) {
    moving_body body{s.points, pose, std::move(outline), nullptr, nullptr};
    body.motion = std::make_unique<btDefaultMotionState>(pose(0.0));
    body.outline->setMargin(btScalar(0.001));
    body.rigid = std::make_unique<btRigidBody>(
        btRigidBody::btRigidBodyConstructionInfo(0, body.motion.get(), body.outline.get()));
    body.rigid->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    body.rigid->setActivationState(DISABLE_DEACTIVATION);
    body.rigid->setFriction(btScalar(1));
    world_->addRigidBody(body.rigid.get());
    obstacle_surface own{s.triangles, {}, {}};
    for (const btVector3 &p : s.points) own.from.push_back(pose(0.0) * p);
    own.to = own.from;
    obstacles_.push_back(std::move(own));
    moving_.push_back(std::move(body));
}

void bullet_scene::add_ball(double radius, const std::function<btTransform(double)> &pose) {
    add_obstacle(ball_of(1280, radius), std::make_unique<btSphereShape>(static_cast<btScalar>(radius)), pose);
}

/* A box of Bullet has its middle at 0. */
void bullet_scene::add_plate(double reach, const std::function<btTransform(double)> &pose) {
    const double thickness = 0.2;
    surface plate = plate_of(reach, thickness);
    for (btVector3 &p : plate.points) p += point_of(0, 0, 0.5 * thickness);
    add_obstacle(plate, std::make_unique<btBoxShape>(point_of(reach, reach, 0.5 * thickness)), pose);
}

/* ---- scenes -------------------------------------------------------------------------------------------- */

void bullet_scene::add_twist(unsigned triangle_count) {
    add_soft(sheet_of(triangle_count, 1.0), moved_by(0.02, -0.01, 0.32), 0.3, 0.2);
    add_ball(0.25,
             [](double time) { return turned_by(pi * (1.0 - std::cos(1.2 * std::max(0.0, time - 0.6)))); });
}

void bullet_scene::add_press(unsigned triangle_count, double depth) {
    add_soft(ball_of(triangle_count, 0.5), moved_by(0, 0, 0.53), 0.5, 1.0);
    add_plate(0.7, [](double) { return moved_by(0, 0, -0.1); });
    add_plate(0.7, [depth](double time) {
        return moved_by(0, 0,
                        1.2 - depth * smooth_share(time, 0.3, 2.5) + 0.6 * smooth_share(time, 3.5, 2.0));
    });
}

void bullet_scene::add_bounce(unsigned triangle_count) {
    btSoftBody &ball = add_soft(ball_of(triangle_count, 0.5), moved_by(0, 0, 0.8), 0.5, 0.2);
    ball.m_cfg.kPR = btScalar(10);
    ball.setVelocity(btVector3(btScalar(0.5), 0, -6));
    add_plate(2.0, [](double) { return moved_by(0, 0, -0.1); });
    add_plate(2.0, [](double time) {
        return moved_by(0, 0, 3.0 - 2.5 * smooth_share(time, 1.5, 2.0) + 1.5 * smooth_share(time, 4.0, 1.5));
    });
}

void bullet_scene::add_stack(unsigned triangle_count) {
    for (unsigned i = 0; i < 6; i++)
        add_soft(sheet_of(triangle_count / 6, 1.0), moved_by(0, 0, 0.05 + 0.05 * i) * turned_by(0.3 * i), 0.3,
                 0.2);
    add_plate(1.2, [](double time) {
        return moved_by(0.15 * (1.0 - std::cos(4.0 * std::max(0.0, time - 0.5))), 0, -0.1);
    });
}

void bullet_scene::add_sleeve(unsigned triangle_count) {
    const double height = 1.0;
    btSoftBody &tube = add_soft(tube_of(triangle_count, 0.15, height), moved_by(0, 0, 0), 0.3, 0.2);
    for (int i = 0; i < tube.m_nodes.size(); i++) {
        const double z = tube.m_nodes[i].m_x.z();
        if (z > 0.02 && z < height - 0.02) continue;
        tube.setMass(i, 0);
        held_.push_back({&tube.m_nodes[i], tube.m_nodes[i].m_x, z < 0.5 ? -1.0 : 1.0});
    }
}

bullet_scene::bullet_scene(bullet_kind kind, unsigned triangle_count, bool collides)
    : collides_(collides), world_(std::make_unique<btSoftRigidDynamicsWorld>(&dispatcher_, &broadphase_,
                                                                             &solver_, &configuration_)) {
    const btVector3 down = point_of(0, 0, kind == bullet_kind::sleeve ? 0.0 : -gravity);
    world_->setGravity(down);
    world_->getWorldInfo().m_gravity = down;
    world_->getWorldInfo().m_sparsesdf.setDefaultVoxelsz(btScalar(0.05));
    world_->getWorldInfo().m_sparsesdf.Initialize();
    switch (kind) {
    case bullet_kind::twist:
        add_twist(triangle_count);
        break;
    case bullet_kind::press:
        add_press(triangle_count, 0.9);
        break;
    case bullet_kind::crush:
        add_press(triangle_count, 1.07);
        break;
    case bullet_kind::bounce:
        add_bounce(triangle_count);
        break;
    case bullet_kind::stack:
        add_stack(triangle_count);
        break;
    case bullet_kind::sleeve:
        add_sleeve(triangle_count);
        break;
    }
}

bullet_scene::~bullet_scene() {
    for (auto &body : soft_) world_->removeSoftBody(body.get());
    for (auto &body : moving_) world_->removeRigidBody(body.rigid.get());
}

/* ---- one frame ----------------------------------------------------------------------------------------- */

/* The ends of the sleeve turn against each other and come nearer. */
btVector3 bullet_scene::place_of(const held_node &held, double time) const {
    const double share = smooth_share(time, 0.0, 4.0), angle = held.side * 1.5 * pi * share;
    return turned_by(angle) * held.rest - point_of(0, 0, held.side * 0.15 * share);
}

void bullet_scene::step() {
    const double time = clock_ + frame_seconds;
    for (std::size_t i = 0; i < moving_.size(); i++) {
        const btTransform pose = moving_[i].pose(time);
        moving_[i].motion->setWorldTransform(pose);
        for (std::size_t v = 0; v < moving_[i].shape.size(); v++)
            obstacles_[i].to[v] = pose * moving_[i].shape[v];
    }
    for (const held_node &held : held_)
        held.node->m_v = (place_of(held, time) - held.node->m_x) / frame_seconds;
    world_->stepSimulation(frame_seconds, 0);
}

void bullet_scene::end_frame(double obstacle_share) {
    clock_ += obstacle_share * frame_seconds;
    for (obstacle_surface &o : obstacles_) o.from = o.to;
}
