// SPDX-License-Identifier: Apache-2.0
// The mouse and the keys as a hand in the scene, for the driver 'mouse'.
#pragma once

#include "devices/haptic/window_hand.hpp"
#include "dsp/display/camera.hpp"
#include "engine/observe/observer.hpp"
#include "tools/render/scene_outline.hpp"
#include "tools/window/hand/hand_cursor.hpp"
#include "tools/window/hand/hand_pulse.hpp"
#include "tools/window/hand/hand_sight.hpp"
#include "tools/window/hand/place_watch.hpp"
#include "tools/window/widgets/painter.hpp"

#include <functional>
#include <memory>
#include <optional>

namespace tactus::window {

class SceneHand {
public:
    SceneHand();

    /// Once per picture, and while there are none because the window is minimised. From here to the end of the picture a
    /// thread says that the window is alive, see HandPulse.
    void begin_picture();
    void end_picture();
    /// Tells the driver where the hand is wanted, and that the window is alive.
    void beat();
    /// Lets go of everything, because the person has left the window: what is held must be pressed anew.
    void let_go();
    /// The run stands still: its device is not read, and the hand stays where it is.
    void stand(bool stands) { stands_ = stands; }
    /// A device of the run is moved by the window.
    bool is_there() const { return is_there_; }
    /// The mouse in the scene moves the hand, not the view.
    bool has_mouse() const { return is_there_ && is_on_; }

    /// Watches where the device lies in the scene; null: no run.
    void follow(const std::shared_ptr<observe::Observer>& observer, const render::SceneOutline& outline,
                const compile::Schedule& plan);
    void forget() { place_.forget(); }
    /// The buttons above the scene; without a hand of the window, `offer`.
    void tools();
    std::function<void()> offer;
    /// The four buttons of the hand, 0 to 3: trigger, second, third, fourth.
    bool is_held(std::size_t button) const { return ((keys_ | latched_) >> button & 1u) != 0; }
    /// Holds one until it is let go, as a click on its button above the scene.
    void hold(std::size_t button, bool wanted);
    /// The hand goes to a point of the scene, as fast as the driver lets it.
    void go_to(const Vec3& to);
    /// Mouse and keys over the scene, whose picture is so high, pixels. True when the mouse is the hand's.
    bool steer(const display::OrbitCamera& camera, int height);
    /// What is seen of it; none: it is not there.
    std::optional<HandSight> sight(double limit_N) const;
    /// Says that the driver has let go, because pictures came too late.
    void draw_silence(const Painter& paint, const Box& picture) const;

private:
    Vec3 cursor_in_scene(const HandPlace& place) const;
    std::int64_t held_buttons() const;
    void press_keys();
    void drop_keys();
    void step_by_keys(const Vec3& right, const Vec3& up, const Vec3& forward, const HandPlace& place);

    HandPulse pulse_;
    PlaceWatch place_;
    haptic::FeltHand felt_;
    HandCursor cursor_;
    std::int64_t run_ = 0, picture_ns_ = 0, interval_ns_ = 0, ticked_ns_ = 0, first_ns_ = 0;
    int pictures_ = 0;  // of this run; the first ones make meshes and take long
    bool is_steered_ = false, stands_ = false;
    bool is_there_ = false, is_on_ = true, is_hovered_ = false;
    unsigned keys_ = 0, latched_ = 0;  // of the four buttons, bit by bit
    unsigned stale_ = 0;  // keys that were down when the person left
    bool is_drag_stale_ = false;
    std::int64_t spoke_ns_ = 0;
};

}  // namespace tactus::window
