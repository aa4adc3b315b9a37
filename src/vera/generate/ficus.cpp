// SPDX-License-Identifier: Apache-2.0
#include "vera/generate/ficus.h"

#include "vera/generate/chance.h"
#include "vera/generate/leaf.h"
#include "vera/generate/scene_parts.h"
#include "vera/math/elementary.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace vera {

namespace {

constexpr double golden_turn = 137.50776405003785; // degrees between leaves that follow each other
constexpr double longest_internode = 0.045;        // metres
constexpr double longest_leaf = 0.27;
constexpr double longest_stalk = 0.05;
constexpr std::size_t leaf_life = 24; ///< plastochrons, until it falls
constexpr double earth_height = 0.20;

/// The piece of a shoot that grows with one leaf, and the bud in the leaf's axil.
struct Internode {
    std::size_t born = 0; ///< in plastochrons: the time from one leaf of a shoot to the next
    Vec3 direction;
    double turn_degrees = 0;    ///< of the leaf about the shoot
    std::ptrdiff_t branch = -1; ///< the shoot that the bud has become
};

/// What one growing tip has made.
struct Shoot {
    Vec3 start;                        ///< of a shoot out of the earth
    std::ptrdiff_t parent = -1;        ///< the shoot on which it grows
    std::size_t node = 0;              ///< and its number of an internode there
    double vigour = 1;                 ///< size of what it makes
    std::vector<Internode> internodes; ///< from the oldest to the youngest
};

struct GrowthRules {
    std::size_t age = 34;
    std::size_t stems = 3;
    std::size_t dominance = 11;
    double branching = 0.2;
    std::uint64_t seed = 3;
};

/// How far something of that age has grown, from 0 to 1: slowly, then fast, then to its end.
double grown_part(double age, double full_age) {
    const double t = std::clamp(age / full_age, 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

/// A unit vector that leans from `axis` by an angle, towards the side that the turn about it says.
Vec3 leaning(Vec3 axis, double lean_degrees, double turn_degrees) {
    const double across = sin_degrees(lean_degrees);
    const Vec3 from_y = {
        across * sin_degrees(turn_degrees),
        cos_degrees(lean_degrees),
        across * cos_degrees(turn_degrees)};
    return normalized(transformed_vector(turned_from_y(axis), from_y));
}

/// Grows the plant step by step. In each step every tip makes an internode with a leaf, and buds
/// that no tip keeps asleep any more may wake.
class Growth {
public:
    explicit Growth(const GrowthRules& rules)
        : rules_(rules) {
        for (std::size_t i = 0; i < rules.stems; ++i)
            plant(i);
        for (now_ = 1; now_ <= rules.age; ++now_) {
            const std::size_t shoots = shoots_.size();
            for (std::size_t i = 0; i < shoots; ++i)
                grow(i);
            for (std::size_t i = 0; i < shoots; ++i)
                wake_buds(i);
        }
    }

    std::vector<Shoot> take() { return std::move(shoots_); }

private:
    void plant(std::size_t i) {
        Chance chance(rules_.seed, i);
        const double turn = 360.0 * static_cast<double>(i) / static_cast<double>(rules_.stems)
            + chance.between(-25, 25);
        const double off = rules_.stems == 1 ? 0 : 0.055;
        Shoot shoot;
        shoot.start = {off * sin_degrees(turn), earth_height, off * cos_degrees(turn)};
        // Later shoots are younger, and so lower.
        birth_.push_back(i * rules_.age / (2 * rules_.stems));
        tips_.push_back(leaning({0, 1, 0}, rules_.stems == 1 ? 1 : chance.between(6, 14), turn));
        shoots_.push_back(std::move(shoot));
    }

    void grow(std::size_t i) {
        if (now_ <= birth_[i])
            return;
        Shoot& shoot = shoots_[i];
        const std::size_t number = shoot.internodes.size();
        Chance chance(rules_.seed + 1, 100'000 * i + number);
        // A tip wanders, and turns up to the light.
        const double aside = chance.between(0, 360);
        const double lean = chance.between(0, 7);
        const Vec3 wandering = leaning(tips_[i], lean, aside);
        tips_[i] = normalized(wandering + Vec3{0, 0.05, 0});
        shoot.internodes.push_back(
            {.born = now_,
             .direction = tips_[i],
             .turn_degrees =
                 golden_turn * static_cast<double>(number + 7 * i) + chance.between(-12, 12)});
    }

    /// A tip keeps the buds near it asleep; farther down one may wake.
    void wake_buds(std::size_t i) {
        const std::size_t count = shoots_[i].internodes.size();
        constexpr std::size_t lowest = 5; // buds below are too old
        if (count <= rules_.dominance || count - rules_.dominance < lowest)
            return;
        const std::size_t node = count - rules_.dominance;
        Chance chance(rules_.seed + 2, 100'000 * i + node);
        if (chance.between(0, 1) >= rules_.branching * shoots_[i].vigour
            || shoots_[i].internodes[node].branch >= 0)
            return;
        Shoot branch;
        branch.parent = static_cast<std::ptrdiff_t>(i);
        branch.node = node;
        branch.vigour = 0.85 * shoots_[i].vigour;
        shoots_[i].internodes[node].branch = static_cast<std::ptrdiff_t>(shoots_.size());
        const Internode& internode = shoots_[i].internodes[node];
        tips_.push_back(leaning(internode.direction, 48, internode.turn_degrees));
        birth_.push_back(now_);
        shoots_.push_back(std::move(branch));
    }

    GrowthRules rules_;
    std::size_t now_ = 0;
    std::vector<Shoot> shoots_;
    std::vector<Vec3> tips_;         ///< where each shoot's tip points
    std::vector<std::size_t> birth_; ///< the step after which a shoot grows
};

/// Leaves that stand on an internode or farther along, branches included: what its wood must feed.
std::vector<std::vector<double>> leaves_above(const std::vector<Shoot>& shoots) {
    std::vector<std::vector<double>> above(shoots.size());
    // Branches come later in the list than what they grow on.
    for (std::size_t i = shoots.size(); i-- > 0;) {
        const Shoot& shoot = shoots[i];
        above[i].resize(shoot.internodes.size());
        double sum = 0;
        for (std::size_t node = shoot.internodes.size(); node-- > 0;) {
            sum += shoot.vigour;
            const std::ptrdiff_t branch = shoot.internodes[node].branch;
            if (branch >= 0 && !above[static_cast<std::size_t>(branch)].empty())
                sum += above[static_cast<std::size_t>(branch)].front();
            above[i][node] = sum;
        }
    }
    return above;
}

struct FicusMaterials {
    MaterialId bark;
    MaterialId leaf;
    MaterialId stalk;
};

/// Puts the plant's geometry into the scene.
class FicusBuilder {
public:
    FicusBuilder(Scene& scene, std::size_t age, std::uint64_t seed, std::size_t leaf_triangles)
        : scene_(scene)
        , now_(age)
        , seed_(seed) {
        materials_.bark = add_material(scene, "ficus-bark", {0.40, 0.31, 0.22});
        materials_.leaf = add_material(scene, "ficus-leaf", {0.13, 0.36, 0.10});
        scene.materials.back().arf = {0.04, 0.10, 0.03};
        // Some light comes through.
        scene.materials.back().sdi = {0.015, 0.045, 0.01};
        scene.materials.back().rab = {0.035, 0.04, 0.035};
        scene.materials.back().spc = 0.955;
        materials_.stalk = add_material(scene, "ficus-stalk", {0.42, 0.42, 0.18});
        leaf_ = add_leaf(leaf_triangles);
    }

    void add_plant(const std::vector<Shoot>& shoots) {
        const auto feeds = leaves_above(shoots);
        std::vector<std::vector<Vec3>> ends(shoots.size());
        for (std::size_t i = 0; i < shoots.size(); ++i) {
            const Shoot& shoot = shoots[i];
            Vec3 at = shoot.start;
            if (shoot.parent >= 0)
                at = ends[static_cast<std::size_t>(shoot.parent)][shoot.node];
            for (std::size_t node = 0; node < shoot.internodes.size(); ++node) {
                at = add_internode(shoot, node, at, feeds[i]);
                ends[i].push_back(at);
                add_leaf_at(shoot, node, at, 100'000 * i + node);
            }
            add_bud(shoot, at);
        }
    }

private:
    SubsceneId add_leaf(std::size_t triangles) {
        // As many rows as make triangles about as long as wide.
        LeafForm form;
        form.columns = std::max<std::size_t>(
            1, static_cast<std::size_t>(std::sqrt(static_cast<double>(triangles) / 20)));
        form.rows = std::max<std::size_t>(2, triangles / (4 * form.columns));
        form.half_width = 0.25;
        form.waves = 0.006;
        // So much that the midrib is a crease in drawings, whatever the veins beside it do.
        form.fold = 0.45;
        const SubsceneId leaf = add_subscene(scene_, "ficus-leaf-blade");
        add(geometry_of(scene_, leaf), leaf_blade(form));
        return leaf;
    }

    double age_of(const Internode& internode) const {
        return static_cast<double>(now_ - internode.born);
    }

    /// By the pipe model: the area of the wood is that of what it feeds (Shinozaki et al. 1964).
    static double radius(double leaves_fed) { return 0.0024 * std::sqrt(leaves_fed) + 0.0006; }

    /// Returns where it ends.
    Vec3 add_internode(
        const Shoot& shoot, std::size_t node, Vec3 start, const std::vector<double>& feeds) {
        const Internode& internode = shoot.internodes[node];
        const double part = 0.2 + 0.8 * grown_part(age_of(internode), 5);
        const Vec3 end =
            short_decimals(start + longest_internode * shoot.vigour * part * internode.direction);
        const double next = node + 1 < feeds.size() ? feeds[node + 1] : 0.3;
        const double end_radius = radius(next);
        add(scene_.geometry,
            cone_between(start, radius(feeds[node]), end, end_radius),
            materials_.bark);
        add(scene_.geometry, Sphere{end, end_radius}, materials_.bark);
        return end;
    }

    void add_leaf_at(const Shoot& shoot, std::size_t node, Vec3 at, std::uint64_t thing) {
        const Internode& internode = shoot.internodes[node];
        const double age = age_of(internode);
        Chance chance(seed_ + 3, thing);
        if (age > static_cast<double>(leaf_life) * chance.between(0.75, 1.1))
            return;
        const double part = 0.25 + 0.75 * grown_part(age, 6);
        const double size =
            longest_leaf * part * chance.between(0.85, 1.1) * (0.55 + 0.45 * shoot.vigour);
        // Young leaves stand upright, old ones hang.
        const double lean = 22 + 62 * grown_part(age, 12) + chance.between(-8, 8);
        const Vec3 stalk = leaning(internode.direction, lean, internode.turn_degrees);
        const Vec3 base = at + longest_stalk * part * stalk;
        add(scene_.geometry,
            cone_between(at, 0.0022 * part + 0.0006, base, 0.0016 * part + 0.0005),
            materials_.stalk);
        const Vec3 along = normalized(stalk - Vec3{0, 0.25 * grown_part(age, 14), 0});
        add_call(
            scene_.geometry,
            leaf_,
            short_decimals(leaf_placement(along, size, base, chance.between(-14, 14))),
            materials_.leaf);
    }

    /// The blade lies along a direction with its upper side up, turned about itself a little.
    static Affine3 leaf_placement(Vec3 along, double size, Vec3 base, double roll_degrees) {
        Vec3 right = cross(along, {0, 1, 0});
        right = length(right) > 1e-6 ? normalized(right) : Vec3{1, 0, 0};
        const Vec3 up = cross(right, along);
        Affine3 turn;
        for (std::size_t row = 0; row < 3; ++row)
            turn.linear.rows[row] = {right[row], along[row], up[row]};
        return in_turn(rotation({0, roll_degrees, 0}), scaling(size), turn, translation(base));
    }

    /// The sheath of the next leaf, at the tip.
    void add_bud(const Shoot& shoot, Vec3 at) {
        if (shoot.internodes.empty())
            return;
        const Vec3 tip = at + 0.045 * shoot.vigour * shoot.internodes.back().direction;
        add(scene_.geometry, cone_between(at, 0.0036, tip, 0.0004), materials_.stalk);
    }

    Scene& scene_;
    std::size_t now_;
    std::uint64_t seed_;
    FicusMaterials materials_ = {};
    SubsceneId leaf_ = {};
};

void add_pot(Scene& scene) {
    const MaterialId clay = add_material(scene, "ficus-pot", {0.62, 0.34, 0.22});
    const MaterialId earth = add_material(scene, "ficus-earth", {0.13, 0.09, 0.06});
    RotationalShape pot;
    pot.axis = {0, 1, 0};
    for (const ContourPiece::Point point :
         {ContourPiece::Point{0.095, 0},
          {0.13, 0.185},
          {0.142, 0.185},
          {0.145, 0.19},
          {0.147, 0.225},
          {0.144, 0.23},
          {0.134, 0.23},
          {0.131, 0.225},
          {0.128, earth_height - 0.01}})
        pot.contour.push_back({.end = point});
    add(scene.geometry, pot, clay);
    RotationalShape ground;
    ground.axis = {0, 1, 0};
    ground.base = {0, earth_height - 0.006, 0};
    ground.start = {0.1295, 0};
    ground.contour.push_back(
        {.kind = ContourPiece::Kind::conic,
         .control = {{{0.06, 0.012}}},
         .weight = 1,
         .end = {0, 0.012}});
    add(scene.geometry, ground, earth);
}

} // namespace

Scene make_ficus(const ParameterValues& values) {
    Scene scene;
    const GrowthRules rules = {
        .age = values.whole("age"),
        .stems = values.whole("stems"),
        .dominance = values.whole("dominance"),
        .branching = values["branching"],
        .seed = values.whole("seed")};
    add_pot(scene);
    FicusBuilder builder(scene, rules.age, rules.seed, values.whole("triangles"));
    builder.add_plant(Growth(rules).take());
    return scene;
}

} // namespace vera
