/* Soft bodies of Bullet that press on each other, on themselves and on obstacles with given motions. */
#pragma once

#include "tests/engine/safe_bodies.hpp"

#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <functional>
#include <memory>

/* twist    a sheet falls onto a ball, which turns to and fro and winds it up
 * press    a hollow ball between two plates, the upper of which comes down and goes up again
 * crush    the same, and the plates come so near that hardly anything has room between them
 * bounce   a ball with inner pressure is thrown onto the floor, and a plate squeezes it
 * stack    six sheets fall onto each other and onto a floor, which slides to and fro
 * sleeve   a tube whose ends turn against each other and come nearer */
enum class bullet_kind { twist, press, crush, bounce, stack, sleeve };
constexpr std::array<const char *, 6> bullet_kind_names{"twist",  "press", "crush",
                                                        "bounce", "stack", "sleeve"};

/* A world of Bullet, as an engine has it: nothing of cscd is in it. */
class bullet_scene {
  public:
    /* collides: Bullet keeps bodies apart in its own ways, by fields of distance and by vertices and faces. */
    bullet_scene(bullet_kind kind, unsigned triangle_count, bool collides);
    bullet_scene(const bullet_scene &) = delete;
    bullet_scene &operator=(const bullet_scene &) = delete;
    ~bullet_scene();

    /* Bullet moves everything to the end of the frame. */
    void step();
    /* Takes over what came of the frame: by which share of their ways the obstacles have gone. */
    void end_frame(double obstacle_share);

    static constexpr btScalar frame_seconds = btScalar(1) / 60;
    cscd::span<btSoftBody *const> soft_bodies() const {
        const btSoftBodyArray &all = world_->getSoftBodyArray();
        return {&all[0], static_cast<std::size_t>(all.size())};
    }
    std::vector<obstacle_surface> &obstacles() {
        return obstacles_;
    }
    double spacing() const {
        return spacing_;
    }

  private:
    struct moving_body {
        std::vector<btVector3> shape;
        std::function<btTransform(double)> pose; /* by the time */
        std::unique_ptr<btCollisionShape> outline;
        std::unique_ptr<btMotionState> motion;
        std::unique_ptr<btRigidBody> rigid;
    };
    struct held_node {
        btSoftBody::Node *node;
        btVector3 rest;
        double side;
    };
    struct surface {
        std::vector<btVector3> points;
        std::vector<std::array<std::uint32_t, 3>> triangles;
    };

    static surface sheet_of(unsigned triangle_count, double width);
    static surface ball_of(unsigned triangle_count, double radius);
    static surface tube_of(unsigned triangle_count, double radius, double height);
    static surface plate_of(double reach, double thickness);
    btSoftBody &add_soft(const surface &s, const btTransform &place, double mass, double bending_stiffness);
    void add_ball(double radius, const std::function<btTransform(double)> &pose);
    void add_plate(double reach, const std::function<btTransform(double)> &pose);
    void add_obstacle(const surface &s, std::unique_ptr<btCollisionShape> outline,
                      const std::function<btTransform(double)> &pose);
    void add_twist(unsigned triangle_count);
    void add_press(unsigned triangle_count, double depth);
    void add_bounce(unsigned triangle_count);
    void add_stack(unsigned triangle_count);
    void add_sleeve(unsigned triangle_count);
    btVector3 place_of(const held_node &held, double time) const;

    const bool collides_;
    btSoftBodyRigidBodyCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btSequentialImpulseConstraintSolver solver_;
    std::unique_ptr<btSoftRigidDynamicsWorld> world_;
    std::vector<std::unique_ptr<btSoftBody>> soft_;
    std::vector<moving_body> moving_;
    std::vector<obstacle_surface> obstacles_;
    std::vector<held_node> held_;
    double spacing_ = 0.0, clock_ = 0.0;
};
