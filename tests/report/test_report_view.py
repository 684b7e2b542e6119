"""What reports show and how they are used, in a real browser: controls, frames, the view and its pictures, charts."""
import charts_scenarios
import controls_scenarios
import frames_scenarios
import view_scenarios
from browser import context, play, scenarios_of  # noqa: F401


@scenarios_of(controls_scenarios, frames_scenarios, view_scenarios, charts_scenarios)
def test_scenario(scenario, context, capsys):  # noqa: F811
    play(scenario, context, capsys)
