from catkin_pkg.python_setup import generate_distutils_setup
from distutils.core import setup

setup(**generate_distutils_setup(
    packages=['casepush_analysis', 'casepush_analysis.figures'],
    package_dir={'': 'src/analysis'},
    package_data={'casepush_analysis': ['report.html.j2']},
))
