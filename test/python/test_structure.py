"""The rules of the architecture, checked on the sources: rooms, libraries, tests, headers."""
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]

# A room may include those of lower layers only; siblings never meet.
LAYERS = [
    {"common"},
    {"model"},
    {"world"},
    {"sim", "perception", "cases", "planning"},
    {"execution", "analysis"},
    {"ros", "rviz_plugins", "lab"},
    {"nodes", "tools"},
]
LAYER = {room: level for level, rooms in enumerate(LAYERS) for room in rooms}

# Third-party headers and the rooms that may include them.
ROS = {"ros", "rviz_plugins", "nodes"}
LIBRARIES = {
    r"yaml-cpp/": {"common", "cases"},
    r"urdf_\w+/|console_bridge/": {"model"},
    r"octomap/": {"world"},
    r"fcl/": {"world"},
    r"ompl/": {"planning"},
    r"sqlite3": {"cases"},
    r"bt[A-Z]|Bullet\w+/|LinearMath/": {"sim"},
    r"apriltag": {"perception"},
    r"CLI/": {"tools"},
    r"nlohmann/": {"lab", "ros", "tools"},
    r"rviz/|Q[A-Z]|Ogre": {"rviz_plugins"},
    r"pluginlib/": {"rviz_plugins"},
    r"casepush/|ros/|\w+_msgs/|std_srvs/|tf2\w*/|actionlib/|message_filters/": ROS,
    r"diagnostic_updater/|dynamic_reconfigure/|interactive_markers/|xmlrpcpp/": ROS,
    r"cv_bridge/|image_transport/|rosbag/|rosconsole_bridge/|topic_tools/": ROS,
}
ANYWHERE = re.compile(r"Eigen/|boost/|sys/")

LINE_LIMIT = 400
INCLUDE = re.compile(r'^\s*#\s*include\s+([<"])([^>"]+)[>"]', re.MULTILINE)


def sources(*patterns):
    folders = ("include", "src", "test", "benchmark", "scripts", "cmake")
    found = [f for p in patterns for d in folders for f in (ROOT / d).rglob(p)]
    return sorted(f for f in found if "__pycache__" not in f.parts)


def room_of(path):
    """Room of a C++ file of the program; None for tests and benchmarks."""
    parts = path.relative_to(ROOT).parts
    if parts[0] == "include":
        return parts[2] if parts[1] == "casepush" else None
    return parts[1] if parts[0] == "src" else None


def includes():
    """(file, room, bracket, header) of every include of the program."""
    for path in sources("*.h", "*.cpp"):
        room = room_of(path)
        if room:
            for bracket, header in INCLUDE.findall(path.read_text()):
                yield path.relative_to(ROOT), room, bracket, header


def read_cmake(path):
    """Text of a CMake file without comments and with its foreach loops written out."""

    def write_out(match):
        variable, values, body = match.groups()
        return "".join(body.replace("${" + variable + "}", value) for value in values.split())

    text = re.sub(r"#.*", "", path.read_text())
    loop = re.compile(r"foreach\(\s*(\w+)\s+([^)]*)\)(.*?)endforeach\(\)", re.DOTALL)
    return loop.sub(write_out, text)


def test_the_rules_see_the_program():
    assert len(list(includes())) > 100


def test_every_room_is_known():
    rooms = {p.name for p in (ROOT / "src").iterdir() if p.is_dir()}
    rooms |= {p.name for p in (ROOT / "include" / "casepush").iterdir() if p.is_dir()}
    assert rooms <= set(LAYER)


def test_rooms_depend_on_lower_rooms_only():
    wrong = []
    for path, room, bracket, header in includes():
        match = re.match(r"casepush/(\w+)/", header) if bracket == '"' else None
        if match and match[1] != room and LAYER[match[1]] >= LAYER[room]:
            wrong.append(f"{path} ({room}) includes {header}")
    assert not wrong, "\n".join(wrong)


def test_libraries_link_lower_rooms_only():
    wrong = []
    for path in (ROOT / "src").glob("*/CMakeLists.txt"):
        text = read_cmake(path)
        for name, arguments in re.findall(r"casepush_room\(\s*(\w+)([^)]*)\)", text):
            for rooms in re.findall(r"\bROOMS\b([a-z_\s]*)", arguments):
                wrong += [f"{name} links {r}" for r in rooms.split() if LAYER[r] >= LAYER[name]]
    assert not wrong, "\n".join(wrong)


def test_private_headers_stay_in_their_room():
    wrong = []
    for path, room, bracket, header in includes():
        if bracket != '"' or header.startswith("casepush/"):
            continue
        near = [ROOT / path.parent / header, ROOT / "src" / room / header]
        if ".." in header or not any(f.is_file() for f in near):
            wrong.append(f"{path} includes {header}")
    assert not wrong, "\n".join(wrong)


def test_own_headers_exist_and_are_quoted():
    wrong = []
    for path, _, bracket, header in includes():
        is_own = re.match(r"casepush/[a-z_]+/", header)
        if is_own and (bracket != '"' or not (ROOT / "include" / header).is_file()):
            wrong.append(f"{path} includes {header}")
    assert not wrong, "\n".join(wrong)


def test_libraries_stay_in_their_rooms():
    wrong = []
    for path, room, bracket, header in includes():
        if bracket != "<" or ANYWHERE.match(header):
            continue
        rooms = [allowed for pattern, allowed in LIBRARIES.items() if re.match(pattern, header)]
        if not rooms and "/" in header:
            wrong.append(f"{path} includes <{header}>, a library without a room")
        wrong += [f"{path} includes <{header}>" for allowed in rooms if room not in allowed]
    assert not wrong, "\n".join(wrong)


def test_every_source_file_is_built():
    wrong = []
    for folder in (p for p in (ROOT / "src").iterdir() if p.is_dir()):
        lists = " ".join(read_cmake(p) for p in folder.rglob("CMakeLists.txt"))
        listed = set(re.findall(r"[\w./-]+", lists))
        wrong += [str(path.relative_to(ROOT)) for path in sorted(folder.rglob("*.cpp"))
                  if str(path.relative_to(folder)) not in listed]
    assert not wrong, "in no CMakeLists.txt: " + ", ".join(wrong)


def registered(folder, function):
    """First arguments of all calls of a CMake function below a folder."""
    calls = set()
    for path in (ROOT / folder).rglob("CMakeLists.txt"):
        calls |= set(re.findall(function + r"\(\s*([^\s)]+)", read_cmake(path)))
    return calls


def check_registration(folder, pattern, function):
    there = {str(p.relative_to(ROOT / folder)) for p in (ROOT / folder).rglob(pattern)}
    known = registered(folder, function)
    assert there == known, f"unregistered: {there - known}, missing: {known - there}"


def test_every_unit_test_is_registered():
    assert registered("test/unit", "casepush_unit_test")
    check_registration("test/unit", "*_test.cpp", "casepush_unit_test")


def test_every_ros_test_is_registered():
    check_registration("test/ros", "*.test", "casepush_ros_test")


def test_every_python_test_is_registered():
    check_registration("test/python", "test_*.py", "casepush_python_test")


def test_every_folder_is_part_of_the_build():
    root = re.sub(r"#.*", "", (ROOT / "CMakeLists.txt").read_text())
    words = set(re.findall(r"[\w/]+", root))
    wrong = []
    for path in sources("CMakeLists.txt"):
        folder = path.parent.relative_to(ROOT)
        is_room = folder.parts[:-1] in (("src",), ("test", "unit"))
        if str(folder) not in words and not (is_room and folder.name in words):
            wrong.append(str(folder))
    assert not wrong, "not added by the root CMakeLists.txt: " + ", ".join(wrong)


def test_headers_are_guarded():
    wrong = []
    for path in sources("*.h"):
        code = [line for line in path.read_text().splitlines() if not line.startswith("//")]
        if next((line for line in code if line.strip()), "") != "#pragma once":
            wrong.append(str(path.relative_to(ROOT)))
    assert not wrong, "without #pragma once as their first line: " + ", ".join(wrong)


def test_files_stay_short():
    wrong = []
    for path in sources("*.h", "*.cpp", "*.py", "*.cmake", "CMakeLists.txt"):
        lines = len(path.read_text().splitlines())
        if lines > LINE_LIMIT:
            wrong.append(f"{path.relative_to(ROOT)} has {lines}")
    assert not wrong, f"more than {LINE_LIMIT} lines: " + ", ".join(wrong)


def test_no_namespace_is_imported_at_file_scope():
    wrong = [str(path.relative_to(ROOT)) for path in sources("*.h", "*.cpp")
             if re.search(r"^using namespace", path.read_text(), re.MULTILINE)]
    assert not wrong, ", ".join(wrong)
