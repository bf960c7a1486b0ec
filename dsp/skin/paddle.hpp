// SPDX-License-Identifier: Apache-2.0
// A skin paddle laid over a defect: what its perforators allow, what it covers, how it folds.
//
// Research use: the mechanics of the skin and the load that presses it on are assumed (SheetSettings, DrapeSettings).
#pragma once

#include "dsp/reconstruction/fibula_plan.hpp"
#include "dsp/reconstruction/flap.hpp"
#include "dsp/rope/obstacle.hpp"
#include "dsp/skin/sheet.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::skin {

struct DrapeSettings {
    SheetSettings sheet;           ///< its length and width are replaced by the paddle's
    double rope_length = 50e-3;    ///< m: a perforator from bone to skin (50 ± 18 mm, Heitmann 2003)
    double rope_stiffness = 38.0;  ///< N/m: 1.9 N per unit of strain (fibular artery, Kamenskiy 2024) over 50 mm
    double pressure = 500.0;       ///< Pa, towards the defect: a dressing; assumed
    double fold_limit = 1.5707963267948966;  ///< rad over one thickness at the bone
};

/// A perforator that feeds the paddle: from the bone, carried with its segment, to the axis of the paddle.
struct PaddleRope {
    std::string name;
    Vec3 bone{0.0};        ///< m, frame of the jaw
    double along = 0.0;    ///< m from the paddle's middle along its axis, towards the donor's knee
    Vec3 skin{0.0};        ///< m, frame of the jaw, after draping
    double distance =
        0.0;  ///< m, straight from bone to skin with the paddle over the defect: a lower bound of the path
    double slack = 0.0;     ///< m: rope_length - distance; negative: it does not reach
    double tension = 0.0;   ///< N, after draping
};

struct DrapedPaddle {
    std::vector<PaddleRope> ropes;  ///< those that enter the paddle, on kept bone
    std::vector<std::string> unused;  ///< perforators beyond the paddle's ends or on bone that is not kept
    double area_flat = 0.0, area = 0.0;  ///< m²: at rest, draped
    double defect_area = 0.0;  ///< m², of the curve seen along its normal
    double coverage = 0.0;     ///< fraction of defect_area below the paddle
    double fold = 0.0;         ///< rad: largest bend over one thickness where the paddle lies on bone; 0: nowhere
    double touching = 0.0;     ///< fraction of the nodes that lie on bone
    bool is_settled = false;
    std::vector<Vec3> positions;  ///< m, frame of the jaw, row by row
    int columns = 0, rows = 0;
    Vec3 normal{0.0, 0.0, 1.0};  ///< unit, of the defect, away from the bone
};

/// The paddle's own frame in the leg: x along the donor's line, z away from it through the paddle's middle. Throws Error
/// when the middle lies on the line.
Pose paddle_in_leg(const reconstruction::SkinPaddle& paddle, const reconstruction::FibulaInputs& inputs);

/// The segment on whose bone a place of the donor lies, by its position along the donor's line.
std::optional<std::size_t> segment_at(const reconstruction::FibulaInputs& inputs,
                                      const reconstruction::FibulaPlan& plan, const Vec3& place);

/// Lays the paddle over `defect`, a closed curve in the frame of the jaw (at least three points that span an area), with its
/// long axis along the defect's, in the direction that stretches the perforators less. The sheet starts clear of the bone
/// and settles under pressure on a bed through the curve and on `bone` (may be null), sutured along the curve. Perforators
/// pull when they are stretched. Throws Error for a paddle or curve that cannot be laid.
DrapedPaddle drape(const reconstruction::FibulaInputs& inputs, const reconstruction::FibulaPlan& plan,
                   const reconstruction::Flap& flap, std::span<const Vec3> defect, const rope::Obstacle* bone,
                   const DrapeSettings& settings = {});

/// The draped paddle as a closed shell of its thickness, m, frame of the jaw.
geometry::TriangleSurface shell_of(const DrapedPaddle& paddle, double thickness);

}  // namespace tactus::skin
