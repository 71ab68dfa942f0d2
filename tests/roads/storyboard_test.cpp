// Storyboards played over recorded runs: conditions, how long actions take, who is named, what is noted. Times follow
// from the tables by hand, and from what esmini does. SPDX-License-Identifier: MIT
#include <cmath>
#include <functional>
#include <map>

#include "roads/opendrive.h"
#include "roads/road_texts.h"
#include "roads/run_texts.h"

namespace vesper::test {
namespace {

/// Where an entity is, and how fast, at a time.
struct Motion {
    double x, y, speed, heading = 0;
};
std::string table_of(const std::map<std::string, std::function<Motion(double)>>& entities,
                     const std::map<std::string, double>& until = {}) {
    std::string text = kHeader;
    for (int i = 0; i <= 120; ++i) {
        const double t = i * 0.05;
        int id = 0;
        for (const auto& [name, at] : entities) {
            ++id;
            if (until.contains(name) && t > until.at(name)) continue;
            const Motion m = at(t);
            char line[200];
            std::snprintf(line, sizeof line, "%.3f, %d, %s, %.4f, %.4f, 0, %.6f, 0, 0, %.4f, 0, 0\n", t, id,
                          name.c_str(), m.x, m.y, m.heading, m.speed);
            text += line;
        }
    }
    return text;
}

std::string vehicle(const std::string& name, double length, double centre) {
    return "<ScenarioObject name=\"" + name + "\"><Vehicle name=\"v\" vehicleCategory=\"car\"><BoundingBox><Center" +
           quantity("x", centre) + " y=\"0\" z=\"0.75\"/><Dimensions" + quantity("length", length) +
           " width=\"1.8\" height=\"1.5\"/></BoundingBox></Vehicle></ScenarioObject>";
}
const std::string kEntities = vehicle("Ego", 4.5, 1.4) + vehicle("T", 12, 5);

std::string group(const std::string& events, const std::string& actors = "<EntityRef entityRef=\"Ego\"/>",
                  const std::string& name = "g", const std::string& of_actors = "") {
    return "<ManeuverGroup name=\"" + name + "\"><Actors " + of_actors + ">" + actors +
           "</Actors><Maneuver name=\"m\">" + events + "</Maneuver></ManeuverGroup>";
}
std::string act(const std::string& groups, const std::string& name = "a", const std::string& triggers = "") {
    return "<Act name=\"" + name + "\">" + groups + triggers + "</Act>";
}
std::string story(const std::string& acts, const std::string& entities = kEntities,
                  const std::string& parameters = "") {
    return "<OpenSCENARIO><ParameterDeclarations>" + parameters + "</ParameterDeclarations><Entities>" + entities +
           "</Entities><Storyboard><Init><Actions/></Init><Story name=\"s\">" + acts +
           "</Story></Storyboard></OpenSCENARIO>";
}
std::string trigger(const std::string& tag, const std::string& condition, const std::string& of_condition = "") {
    return "<" + tag + "><ConditionGroup><Condition " + of_condition + ">" + condition +
           "</Condition></ConditionGroup></" + tag + ">";
}
std::string by_entity(const std::string& condition, const std::string& who = "Ego", const std::string& rule = "any") {
    return "<ByEntityCondition><TriggeringEntities triggeringEntitiesRule=\"" + rule + "\"><EntityRef entityRef=\"" +
           who + "\"/></TriggeringEntities><EntityCondition>" + condition + "</EntityCondition></ByEntityCondition>";
}
std::string state_of(const std::string& kind, const std::string& name, const std::string& state) {
    return "<ByValueCondition><StoryboardElementStateCondition storyboardElementType=\"" + kind +
           "\" storyboardElementRef=\"" + name + "\" state=\"" + state + "\"/></ByValueCondition>";
}
std::string longitudinal(const std::string& action) {
    return "<PrivateAction><LongitudinalAction>" + action + "</LongitudinalAction></PrivateAction>";
}
std::string lateral(const std::string& action) {
    return "<PrivateAction><LateralAction>" + action + "</LateralAction></PrivateAction>";
}
std::string speed_action(double seconds) {
    return longitudinal("<SpeedAction><SpeedActionDynamics dynamicsShape=\"linear\" dynamicsDimension=\"time\"" +
                        quantity("value", seconds) +
                        "/><SpeedActionTarget><AbsoluteTargetSpeed value=\"10\"/></SpeedActionTarget></SpeedAction>");
}
const std::string kLamp = lamp("highBeam", "on");

class Storyboards : public RunFiles {
protected:
    /// Ego goes 10 m/s along x from 50; T stands ahead, 3.5 m to the right.
    std::string table_ = table_of({{"Ego",
                                    [](double t) {
                                        return Motion{50 + 10 * t, -1.75, 10};
                                    }},
                                   {"T", [](double) {
                                        return Motion{80, -5.25, 0};
                                    }}});
    std::string roads_ =
        "<OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/>" +
        std::string("<road name=\"\" length=\"600\" id=\"1\" junction=\"-1\"><planView>") +
        geometry(0, 0, 0, 0, 600, "<line/>") +
        "</planView><lanes><laneSection s=\"0\"><center><lane id=\"0\" type=\"none\"/></center><right>" + lane(-1) +
        lane(-2) + "</right></laneSection></lanes></road></OpenDRIVE>";
    static std::string lane(int id) {
        return "<lane id=\"" + std::to_string(id) +
               "\" type=\"driving\"><width sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/></lane>";
    }

    roads::EsminiRun play(const std::string& text) const {
        const roads::RoadNetwork roads = roads::read_opendrive(write("r.xodr", roads_));
        return roads::read_esmini_run(write("run.csv", table_), write("run.xosc", text), &roads);
    }
    /// When an entity's high beam is set first, NaN: never.
    static double lit(const roads::EsminiRun& run, const std::string& who = "Ego") {
        for (const roads::RunEntity& entity : run.entities) {
            const auto& events = entity.lamps[static_cast<size_t>(roads::RunLamp::HighBeam)];
            if (entity.name == who && !events.empty()) return events[0].time;
        }
        return NAN;
    }
    double lit_when(const std::string& condition, const std::string& of_condition = "delay=\"0\"") const {
        return lit(play(story(act(group(event("e", kLamp, condition, of_condition))))));
    }
    /// When the first event, of this action at `from` s, is complete.
    double done(const std::string& action, const std::string& from = "0") const {
        return lit(play(story(act(group(event("first", action, at_time(from)) +
                                        event("then", kLamp, state_of("event", "first", "completeState")))))));
    }
    std::string notes(const std::string& text) const {
        std::string all;
        for (const std::string& note : play(text).notes) all += note + "\n";
        return all;
    }
};

#define EXPECT_TIME(got, wanted) EXPECT_NEAR(got, wanted, 0.101)
#define EXPECT_NEVER(got) EXPECT_TRUE(std::isnan(got)) << got

// T's reference point is 30 m ahead and 3.5 m to the right; its box begins at 79, Ego's ends at 53.65.
TEST_F(Storyboards, DistancesAreMeasuredByTheirKind) {
    const auto relative = [&](const char* type, const char* value, const char* free_space = "false",
                              const char* rule = "lessThan") {
        return lit_when(by_entity(std::string("<RelativeDistanceCondition entityRef=\"T\" relativeDistanceType=\"") +
                                  type + "\" value=\"" + value + "\" freespace=\"" + free_space + "\" rule=\"" + rule +
                                  "\"/>"));
    };
    EXPECT_TIME(relative("longitudinal", "3"), 2.7);
    EXPECT_TIME(relative("cartesianDistance", "10"), (30 - std::sqrt(100 - 3.5 * 3.5)) / 10);
    EXPECT_EQ(relative("lateral", "3.6"), 0);
    EXPECT_NEVER(relative("lateral", "3.6", "false", "greaterThan"));
    EXPECT_TIME(relative("longitudinal", "5", "true"), 2.035);
    EXPECT_EQ(relative("lateral", "1.71", "true"), 0);
    EXPECT_NEVER(relative("lateral", "1.69", "true")) << "3.5 m less half of both widths";
    EXPECT_TIME(relative("euclidianDistance", "5", "true"), (25.35 - std::sqrt(25 - 1.7 * 1.7)) / 10);
    EXPECT_TIME(lit_when(by_entity(
                    "<DistanceCondition value=\"5\" freespace=\"true\" rule=\"lessThan\"><Position><WorldPosition "
                    "x=\"70\" y=\"-1.75\"/></Position></DistanceCondition>")),
                1.135);
    const std::string to_t = "value=\"1\" freespace=\"false\" rule=\"lessThan\" relativeDistanceType=\"longitudinal\"";
    EXPECT_TIME(lit_when(by_entity("<TimeHeadwayCondition entityRef=\"T\" " + to_t + "/>")), 2);
    EXPECT_TIME(lit_when(by_entity("<TimeToCollisionCondition " + to_t +
                                   "><TimeToCollisionConditionTarget><EntityRef "
                                   "entityRef=\"T\"/></TimeToCollisionConditionTarget></TimeToCollisionCondition>")),
                2);
    EXPECT_NE(notes(story(act(group(
                        event("e", kLamp,
                              by_entity("<RelativeDistanceCondition entityRef=\"T\" relativeDistanceType=\"lateral\" "
                                        "coordinateSystem=\"lane\" value=\"1\"/>"))))))
                  .find("a distance in the lane is measured by the entity's heading"),
              std::string::npos);
}

// A box turned by 45 degrees reaches half its diagonal towards another; corners lie nearest.
TEST_F(Storyboards, FreeSpaceIsBetweenTurnedBoxes) {
    table_ = table_of({{"Ego",
                        [](double t) {
                            return Motion{10 * t, 0, 10};
                        }},
                       {"T", [](double) {
                            return Motion{30, 0, 0, M_PI / 4};
                        }}});
    const auto when = [&](const char* type) {
        return lit(play(
            story(act(group(event("e", kLamp,
                                  by_entity(std::string("<RelativeDistanceCondition entityRef=\"T\" freespace=\"true\" "
                                                        "rule=\"lessThan\" value=\"4\" relativeDistanceType=\"") +
                                            type + "\"/>")))),
                  vehicle("Ego", 4, 0) + vehicle("T", 1.8, 0))));
    };
    EXPECT_TIME(when("euclidianDistance"), (30 - 2 - 1.8 / std::sqrt(2) - 4) / 10);
    EXPECT_TIME(when("longitudinal"), (30 - 2 - 1.8 / std::sqrt(2) - 4) / 10);
}

// T of this run has gone when Ego comes near; who is behind has no headway.
TEST_F(Storyboards, EntitiesThatHaveGoneDoNotTrigger) {
    const auto near = [&] {
        return lit_when(
            by_entity("<RelativeDistanceCondition entityRef=\"T\" value=\"8\" rule=\"lessThan\" "
                      "relativeDistanceType=\"cartesianDistance\"/>"));
    };
    const auto slow = [&] {
        return lit_when(by_entity("<SpeedCondition value=\"1\" rule=\"lessThan\"/>", "T"), "delay=\"2\"");
    };
    EXPECT_TIME(near(), (30 - std::sqrt(64 - 3.5 * 3.5)) / 10);
    EXPECT_TIME(slow(), 2);
    table_ = table_of({{"Ego",
                        [](double t) {
                            return Motion{50 + 10 * t, -1.75, 10};
                        }},
                       {"T",
                        [](double) {
                            return Motion{80, -5.25, 0};
                        }}},
                      {{"T", 1}});
    EXPECT_NEVER(near());
    EXPECT_NEVER(lit_when(by_entity("<StandStillCondition duration=\"1.5\"/>", "T")));
}

TEST_F(Storyboards, ActionsTakeTheirTime) {
    const auto lane_change = [](const std::string& dynamics) {
        return lateral("<LaneChangeAction><LaneChangeActionDynamics " + dynamics +
                       "/><LaneChangeTarget><RelativeTargetLane entityRef=\"Ego\" "
                       "value=\"-1\"/></LaneChangeTarget></LaneChangeAction>");
    };
    const auto to_t = [](const std::string& dynamics, const std::string& of_target) {
        return longitudinal("<SpeedAction><SpeedActionDynamics " + dynamics +
                            "/><SpeedActionTarget><RelativeTargetSpeed entityRef=\"T\" " + of_target +
                            "/></SpeedActionTarget></SpeedAction>");
    };
    EXPECT_TIME(done(lane_change("dynamicsShape=\"linear\" dynamicsDimension=\"time\" value=\"1\"")), 1);
    EXPECT_TIME(done(lane_change("dynamicsShape=\"linear\" dynamicsDimension=\"rate\" value=\"1.75\"")), 2) << "3.5 m";
    EXPECT_TIME(done(lane_change("dynamicsShape=\"sinusoidal\" dynamicsDimension=\"rate\" value=\"1.75\"")), M_PI);
    EXPECT_TIME(done(lane_change("dynamicsShape=\"step\" dynamicsDimension=\"rate\" value=\"1.75\"")), 0);
    EXPECT_TIME(done(to_t("dynamicsShape=\"linear\" dynamicsDimension=\"rate\" value=\"4\"",
                          "value=\"2\" speedTargetValueType=\"delta\"")),
                2)
        << "from 10 to 2 m/s";
    EXPECT_TIME(done(to_t("dynamicsShape=\"linear\" dynamicsDimension=\"distance\" value=\"10\"",
                          "value=\"0\" speedTargetValueType=\"factor\"")),
                2)
        << "20 m at 5 m/s in the mean";
    EXPECT_NEVER(done(
        to_t("dynamicsShape=\"linear\" dynamicsDimension=\"time\" value=\"1\"", "value=\"0\" continuous=\"true\"")));
    EXPECT_TIME(done(longitudinal("<SpeedProfileAction followingMode=\"position\"><SpeedProfileEntry speed=\"10\" "
                                  "time=\"1\"/><SpeedProfileEntry speed=\"20\" time=\"2\"/></SpeedProfileAction>")),
                3);
    EXPECT_TIME(done(lateral("<LaneOffsetAction continuous=\"false\"><LaneOffsetActionDynamics "
                             "dynamicsShape=\"sinusoidal\" maxLateralAcc=\"0.5\"/><LaneOffsetTarget>"
                             "<AbsoluteTargetLaneOffset value=\"1\"/></LaneOffsetTarget></LaneOffsetAction>")),
                M_PI);
    const std::string gap =
        "<LongitudinalDistanceAction entityRef=\"T\" distance=\"20\" freespace=\"false\" continuous=";
    EXPECT_TIME(done(longitudinal(gap + "\"false\"/>")), 1);
    EXPECT_NEVER(done(longitudinal(gap + "\"true\"/>")));
    EXPECT_TIME(done("<PrivateAction><SynchronizeAction masterEntityRef=\"T\"><TargetPositionMaster><WorldPosition "
                     "x=\"90\" y=\"-5.25\"/></TargetPositionMaster><TargetPosition>"
                     "<WorldPosition x=\"70\" y=\"-1.75\"/></TargetPosition></SynchronizeAction></PrivateAction>"),
                2);
    EXPECT_TIME(done(lamp("lowBeam", "on", "", "transitionTime=\"1.5\"")), 1.5);
    EXPECT_NEVER(done(lamp("lowBeam", "flashing")));
    // A third of the way at 10 m/s, then twice as fast.
    table_ = table_of({{"Ego",
                        [](double t) {
                            return t < 1 ? Motion{50 + 10 * t, -1.75, 10} : Motion{60 + 20 * (t - 1), -1.75, 20};
                        }},
                       {"T", [](double) {
                            return Motion{80, -5.25, 0};
                        }}});
    EXPECT_TIME(done(lane_change("dynamicsShape=\"cubic\" dynamicsDimension=\"distance\" value=\"30\"")), 2);
}

TEST_F(Storyboards, TrajectoriesEndWithTheirTimesOrTheirLength) {
    const auto follow = [&](const std::string& timing, const std::string& of_trajectory = "closed=\"false\"") {
        std::string vertices;
        for (const char* t : {"0", "1", "3"})
            vertices += std::string("<Vertex time=\"") + t + "\"><Position><WorldPosition x=\"${50 + 5 * " + t +
                        "}\" y=\"-1.75\"/></Position></Vertex>";
        return done("<PrivateAction><RoutingAction><FollowTrajectoryAction><TrajectoryRef><Trajectory name=\"t\" " +
                        of_trajectory + "><Shape><Polyline>" + vertices +
                        "</Polyline></Shape></Trajectory></TrajectoryRef><TimeReference>" + timing +
                        "</TimeReference></FollowTrajectoryAction></RoutingAction></PrivateAction>",
                    "1");
    };
    EXPECT_TIME(follow("<Timing domainAbsoluteRelative=\"absolute\" scale=\"1\" offset=\"0\"/>"), 3);
    EXPECT_TIME(follow("<Timing domainAbsoluteRelative=\"relative\" scale=\"2\" offset=\"0\"/>"), 2.5);
    EXPECT_TIME(follow("<None/>"), 2.5) << "15 m";
    EXPECT_NEVER(follow("<None/>", "closed=\"true\""));
}

// Another action on the same motion takes its place; that of another motion does not.
TEST_F(Storyboards, ActionsOnTheSameMotionEndOneAnother) {
    const auto first_done = [&](const std::string& second) {
        return lit(play(story(act(group(event("first", speed_action(4), at_time("0"))) +
                                  group(event("second", second, at_time("1")), "<EntityRef entityRef=\"Ego\"/>", "h") +
                                  group(event("then", kLamp, state_of("event", "first", "completeState")),
                                        "<EntityRef entityRef=\"Ego\"/>", "i")))));
    };
    EXPECT_TIME(first_done(speed_action(1)), 1);
    EXPECT_TIME(first_done(lamp("lowBeam", "off")), 4);
}

TEST_F(Storyboards, ParametersAreComparedAndSet) {
    const std::string three = "<ParameterDeclaration name=\"v\" parameterType=\"double\" value=\"3\"/>";
    const auto when = [&](const char* value, const char* rule, const std::string& before = "") {
        return lit(play(story(
            act(group(before + event("e", kLamp,
                                     std::string("<ByValueCondition><ParameterCondition parameterRef=\"v\" value=\"") +
                                         value + "\" rule=\"" + rule + "\"/></ByValueCondition>"))),
            kEntities, three)));
    };
    EXPECT_EQ(when("3.0", "equalTo"), 0);
    EXPECT_EQ(when("2", "greaterThan"), 0);
    EXPECT_EQ(when("20", "lessThan"), 0) << "as numbers";
    EXPECT_NEVER(when("3", "notEqualTo"));
    const auto set = [](const std::string& how) {
        return event("set",
                     "<GlobalAction><ParameterAction parameterRef=\"v\">" + how + "</ParameterAction></GlobalAction>",
                     at_time("1"));
    };
    EXPECT_TIME(when("7", "equalTo", set("<SetAction value=\"7\"/>")), 1);
    EXPECT_TIME(when("5.5", "equalTo", set("<ModifyAction><Rule><AddValue value=\"2.5\"/></Rule></ModifyAction>")), 1);
    EXPECT_TIME(when("6", "equalTo", set("<ModifyAction><Rule><MultiplyByValue value=\"2\"/></Rule></ModifyAction>")),
                1);
}

// Two maneuvers of the same names, of which the path says which one is meant.
TEST_F(Storyboards, ReferencesArePaths) {
    const auto text = [](const std::string& reference) {
        const std::string ego = "<EntityRef entityRef=\"Ego\"/>";
        return story(act(group(event("e", speed_action(0.5), at_time("0")), ego, "g1") +
                             group(event("e", speed_action(1), at_time("2")), ego, "g2"),
                         "a1") +
                     act(group(event("then", kLamp, state_of("event", reference, "completeState")), ego, "g3"), "a2"));
    };
    EXPECT_TIME(lit(play(text("a1::g1::m::e"))), 0.5);
    EXPECT_TIME(lit(play(text("g2::m::e"))), 3);
    EXPECT_TIME(lit(play(text("m::e"))), 0.5) << "the first";
    EXPECT_EQ(notes(text("g2::m::e")), "");
    EXPECT_NE(notes(text("m::e")).find("2 elements are called 'm::e': the first counts"), std::string::npos);
    EXPECT_NE(notes(text("2::m::e")).find("there is no element '2::m::e': it never holds"), std::string::npos);
    EXPECT_NEVER(lit(play(text("2::m::e")))) << "names are whole";
}

// What is so when a condition is looked at first is no edge: the act begins at 2 s, the event's second wait at once.
TEST_F(Storyboards, EdgesBeginWithTheWait) {
    const auto late = [&](const std::string& edge) {
        return lit(play(story(act(group(event("e", kLamp, at_time("1"), "delay=\"0\" conditionEdge=\"" + edge + "\"")),
                                  "a", trigger("StartTrigger", at_time("2"))))));
    };
    EXPECT_TIME(late("none"), 2);
    EXPECT_NEVER(late("rising"));
    EXPECT_TIME(lit_when(at_time("1"), "delay=\"0.5\" conditionEdge=\"rising\""), 1.5);
    EXPECT_TIME(
        lit_when("<ByValueCondition><SimulationTimeCondition value=\"2\" rule=\"lessThan\"/></ByValueCondition>",
                 "delay=\"0\" conditionEdge=\"falling\""),
        2);
}

TEST_F(Storyboards, ActorsAreSelectionsAndWhoTriggers) {
    const std::string selection =
        "<EntitySelection name=\"All\"><Members><ByType objectType=\"vehicle\"/></Members></EntitySelection>";
    const auto all = play(
        story(act(group(event("e", kLamp, at_time("1")), "<EntityRef entityRef=\"All\"/>")), kEntities + selection));
    EXPECT_TIME(lit(all), 1);
    EXPECT_TIME(lit(all, "T"), 1);
    const auto who =
        play(story(act(group(event("e", kLamp, by_entity("<SpeedCondition value=\"1\" rule=\"lessThan\"/>", "All")), "",
                             "g", "selectTriggeringEntities=\"true\"")),
                   kEntities + selection));
    EXPECT_NEVER(lit(who));
    EXPECT_EQ(lit(who, "T"), 0);
    // Of all, one is fast; which rule may be a parameter.
    const std::string rule = "<ParameterDeclaration name=\"r\" parameterType=\"string\" value=\"all\"/>";
    EXPECT_NEVER(lit(play(story(
        act(group(event("e", kLamp, by_entity("<SpeedCondition value=\"5\" rule=\"greaterThan\"/>", "All", "$r")))),
        kEntities + selection, rule))));
}

// A stopped act ends its events, those that never began, too; a story runs from the beginning.
TEST_F(Storyboards, StopsAndStatesAreThoseOfAllElements) {
    const auto after_stop = [&](const std::string& condition) {
        return lit(
            play(story(act(group(event("e", speed_action(100), at_time("0")) + event("f", kLamp, at_time("9"))), "a",
                           trigger("StopTrigger", at_time("1"))) +
                       act(group(event("then", kLamp, condition), "<EntityRef entityRef=\"Ego\"/>", "h"), "b"))));
    };
    for (const char* state : {"completeState", "stopTransition", "endTransition"})
        EXPECT_TIME(after_stop(state_of("event", "e", state)), 1) << state;
    EXPECT_TIME(after_stop(state_of("event", "f", "completeState")), 1);
    EXPECT_TIME(after_stop(state_of("act", "a", "completeState")), 1);
    EXPECT_EQ(after_stop(state_of("story", "s", "runningState")), 0);
    EXPECT_EQ(after_stop(state_of("event", "f", "standbyState")), 0);
    EXPECT_NEVER(after_stop(state_of("story", "s", "completeState")));
}

TEST_F(Storyboards, WhatIsNotReadIsNoted) {
    const auto noted = [&](const std::string& events, const std::string& what) {
        const std::string all = notes(story(act(group(events))));
        EXPECT_NE(all.find(what), std::string::npos) << what << "\n" << all;
    };
    const auto with = [](std::string text, const std::string& from, const std::string& to) {
        return text.replace(text.find(from), from.size(), to);
    };
    const std::string plain = event("e", kLamp, at_time("1"));
    EXPECT_EQ(notes(story(act(group(plain)))), "");
    noted(with(plain, "parallel", "always"), "priority 'always' is none of OpenSCENARIO's");
    noted(with(plain, "conditionEdge=\"none\"", "conditionEdge=\"sticky\""), "conditionEdge 'sticky' is none");
    noted(with(plain, "delay=\"0\"", "delay=\"-1\""), "a delay below 0 counts as none");
    noted(with(plain, "mode=\"on\"", "mode=\"blink\""), "mode 'blink' is none");
    noted(with(plain, "<AppearanceAction>", "<AppearenceAction>")
              .replace(plain.find("</AppearanceAction>"), 19, "</AppearenceAction>"),
          "AppearenceAction: is no action that is known");
    noted(event("e", kLamp, state_of("event", "e", "doneState")),
          "a StoryboardElementStateCondition that cannot be judged");
    noted(event("e", "<PrivateAction><LongitudinalAction><SpeedAction/></LongitudinalAction></PrivateAction>",
                at_time("1")),
          "SpeedAction: its end is not known");
    noted(event("e",
                "<GlobalAction><EnvironmentAction><Environment name=\"e\"><TimeOfDay "
                "dateTime=\"2024-06-01T12:00:00\"/></Environment></EnvironmentAction></GlobalAction>",
                at_time("1")),
          "TimeOfDay: the sky and the weather are those of the scene");
    noted(event("e",
                "<GlobalAction><InfrastructureAction><TrafficSignalAction><TrafficSignalControllerAction/></"
                "TrafficSignalAction></InfrastructureAction></GlobalAction>",
                at_time("1")),
          "controllers of traffic signals are not played");
    noted(event("e", kLamp, by_entity("<SpeedCondition value=\"5\"/>", "Ghost", "all")),
          "'Ghost' is no entity of the run");
    EXPECT_NE(
        notes(story(act(group(plain, "<EntityRef entityRef=\"Nobody\"/>")))).find("Action: there is no actor for it"),
        std::string::npos);
}

// Paths of names are kept for every element.
TEST_F(Storyboards, NamesHaveAnEnd) {
    const auto named = [&](size_t length) {
        return complaint(table_, story(act(group(event("e", kLamp, at_time("1"))), std::string(length, 'n'))));
    };
    EXPECT_EQ(named(1900), "");
    EXPECT_NE(named(2001).find("longer than 2000"), std::string::npos);
}

}  // namespace
}  // namespace vesper::test
