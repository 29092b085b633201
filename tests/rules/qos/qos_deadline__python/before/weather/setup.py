from setuptools import setup

setup(
    name='weather',
    version='1.2.0',
    packages=['weather'],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/weather']),
        ('share/weather', ['package.xml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    entry_points={'console_scripts': ['mast = weather.mast:main', 'flag = weather.flag:main']},
)
